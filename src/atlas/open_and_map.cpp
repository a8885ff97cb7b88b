#include "atlas/open_and_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "atlas/congruent.h"
#include "atlas/measure.h"
#include "atlas/pin_conflicts.h"
#include "atlas/rescue.h"
#include "atlas/seams.h"
#include "base/parallel.h"
#include "base/resources.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "chart/options.h"
#include "cut/edge_marks.h"
#include "cut/search.h"
#include "cut/search_effort.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

// Where these end in the progress.
constexpr double kReady = 0.03;     // of all
constexpr double kMapped = 0.95;    // of a piece; what is left is to rescue charts
constexpr double kCut = 0.15;       // of opening and mapping
constexpr double kFirstTry = 0.6;   // at a target that may be missed
constexpr double kSearched = 0.95;  // then a short cut is tried

/// Missed by more, a target is worth further tries,
constexpr double kMissed = 1e-6;
/// which aim lower by so many times that,
constexpr double kMoreThanMissed = 1.1;
/// but at no less of the excess over 2: what is left then are wrinkles that no cut takes away.
constexpr double kLeastAim = 0.3;
/// Of the excess asked for, fine maps that use no more are worth a further try with shorter seams
/// if coarse ones used more; which aims at so much of it, and at no more than so many times it.
constexpr double kUnused = 0.96, kUsed = 0.9, kAim = 0.975, kMostAim = 2;

/// Throws Error PINS with the first pin that is proven not to go with those before it.
void require_no_conflict(const std::vector<AtlasChart>& charts, const AssignedPins& pins,
                         const std::vector<Pin>& all) {
  std::optional<PinConflict> first;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    auto conflict = find_conflict(charts[c], pins.of_chart[c], all);
    if (conflict && (!first || conflict->pin < first->pin)) first = std::move(conflict);
  }
  if (first) throw unmet(all[first->pin], first->why);
}

/// Throws Error PINS with the first pin that could not be met together with those before it.
void require_met(const std::vector<MappedChart>& maps, const std::vector<Pin>& all) {
  Index first = kNone;
  for (const MappedChart& map : maps) {
    if (map.failed_pin == kNone) continue;
    first = first == kNone ? map.failed_pin : std::min(first, map.failed_pin);
  }
  if (first == kNone) return;
  throw unmet(
      all[first],
      "cannot be met together with those before it: no way was found to bring them all into "
      "place without folding a face");
}

/// Parts with less of the area are searched quickly, whatever is asked: what more shortens their
/// seams is nothing to the whole, and there may be thousands.
constexpr double kSmallPart = 1e-3;

/// Charts of a piece and their maps.
struct Mapped {
  OpenedSurface opened;
  AssignedPins pins;
  std::vector<MappedChart> maps;
  AtlasEnergy energy;
  Index broken = 0;  ///< maps that are not injective
};

/// What all pieces are mapped with.
struct Task {
  const AtlasInput& input;
  const Admitted& admitted;
  const AtlasOptions& options;
  const int exponent;  ///< of the admitted surface
  double area = 0;     ///< of all pieces, in the unit of the whole
};

double area_of(const SurfacePiece& piece, const Work& work) {
  return std::ldexp(surface_area(piece.surface, work), -2 * piece.exponent);
}

SearchEffort effort_for(const Task& task, const SurfacePiece& piece, const Work& work) {
  const bool is_small = area_of(piece, work) < kSmallPart * task.area;
  return is_small ? search_effort(Effort::kQuick) : task.options.effort;
}

void measure(const Work& work, Mapped& mapped) {
  std::vector<ChartInfo> charts(mapped.opened.charts.size());
  mapped.energy = measure_charts(mapped.opened.charts, mapped.maps, 1, charts, work);
  mapped.broken = static_cast<Index>(std::count_if(
      mapped.maps.begin(), mapped.maps.end(),
      [](const MappedChart& map) { return map.error || map.outcome > Outcome::kNotConverged; }));
}

/// One try: charts as `open(work)` makes them, and their maps.
template <class Open>
Mapped open_and_map_once(const Task& task, const Open& open, bool is_timed, const Work& work,
                         std::vector<StageStatistics>& stages) {
  Mapped mapped;
  run_stage("cut", work.part(0, kCut), stages,
            [&](StageStatistics&, const Work& inner) { mapped.opened = open(inner); });
  const AtlasInput& input = task.input;
  std::vector<AtlasChart>& charts = mapped.opened.charts;
  mapped.pins = assign_pins(input.pins, input.faces, task.admitted, charts, task.exponent);
  require_no_conflict(charts, mapped.pins, input.pins);
  run_stage("flatten", work.part(kCut, 1), stages, [&](StageStatistics&, const Work& inner) {
    mapped.maps =
        map_charts(charts, mapped.pins, task.options.chart, is_timed ? inner : inner.untimed());
    require_met(mapped.maps, input.pins);
    measure(inner, mapped);
  });
  return mapped;
}

bool misses(double energy, double target) {
  return target > 0 && energy > target + kMissed;
}

/// The excess over 2 by that which is asked for, of the mean or of the percentile.
double excess_of(const AtlasEnergy& energy, const SeamTarget& target) {
  const double mean = (energy.symmetric_dirichlet - 2) / (target.energy - 2);
  return target.p99 > 0 ? std::max(mean, (energy.p99 - 2) / (target.p99 - 2)) : mean;
}

bool misses(const Mapped& mapped, const SeamTarget& target) {
  return mapped.broken > 0 || misses(mapped.energy.symmetric_dirichlet, target.energy) ||
         misses(mapped.energy.p99, target.p99);
}

/// The target at which coarse maps would leave fine ones the energy that is asked for, if what
/// these have more than those that were made for `aimed` stays; none where a cut cannot bring it.
std::optional<SeamTarget> aimed_lower(const SeamTarget& target, const SeamTarget& aimed,
                                      const Mapped& mapped) {
  const double mean = mapped.energy.symmetric_dirichlet, p99 = mapped.energy.p99;
  const double predicted = mapped.opened.predicted_energy;
  if (misses(predicted, aimed.energy)) return std::nullopt;  // the search has done what it can
  SeamTarget lower = target;
  if (misses(mean, target.energy)) lower.energy -= kMoreThanMissed * (mean - predicted);
  if (misses(p99, target.p99)) lower.p99 = aimed.p99 - kMoreThanMissed * (p99 - target.p99);
  const auto is_possible = [](double aim, double asked) {
    return asked == 0 || aim >= 2 + kLeastAim * (asked - 2);
  };
  const bool is_lower = lower.energy < aimed.energy || lower.p99 < aimed.p99;
  const bool all = is_possible(lower.energy, target.energy) && is_possible(lower.p99, target.p99);
  return is_lower && all ? std::optional(lower) : std::nullopt;
}

/// The target at which coarse maps would leave fine ones all of the energy that is allowed, where
/// these use less of it than the coarse ones did; none where that is not worth a further try.
std::optional<SeamTarget> aimed_higher(const SeamTarget& target, const Mapped& mapped) {
  const double asked = target.energy - 2;
  const double coarse = (mapped.opened.predicted_energy - 2) / asked;
  const double fine = (mapped.energy.symmetric_dirichlet - 2) / asked;
  const EdgeMarks& seams = mapped.opened.seams;
  const bool is_cut = std::find(seams.begin(), seams.end(), true) != seams.end();
  if (!is_cut || target.p99 > 0 || fine > kUnused || coarse < kUsed) return std::nullopt;
  if (kAim * coarse <= fine) return std::nullopt;  // no higher than what the search had
  SeamTarget higher = target;
  higher.energy = 2 + asked * std::min(kAim * coarse / fine, kMostAim);
  return higher;
}

/// The energies at which tries aimed, and those of their maps: the last that missed the target, and
/// the last that did not.
struct Tries {
  std::optional<Vec2> missed, reached;

  void add(double aimed, double energy, bool misses) {
    (misses ? missed : reached) = Vec2(aimed, energy);
  }

  /// The target between them, where maps are to have nearly the energy that is allowed.
  std::optional<SeamTarget> between(const SeamTarget& target) const {
    const double asked = target.energy - 2;
    if (reached->y() - 2 > kUnused * asked) return std::nullopt;
    const Vec2 way = *missed - *reached;
    const double share = (2 + kAim * asked - reached->y()) / way.y();
    SeamTarget aim = target;
    aim.energy = reached->x() + share * way.x();
    return way.x() > 0 && way.y() > 0 ? std::optional(aim) : std::nullopt;
  }
};

/// What to aim at after maps that were made for `aimed`, if it is worth a further try.
std::optional<SeamTarget> aimed_again(const SeamTarget& target, const SeamTarget& aimed,
                                      const Mapped& mapped, const Tries& tries, bool uses_rest) {
  const bool missed = misses(mapped, target);
  if (tries.missed && tries.reached) {
    return uses_rest && target.p99 == 0 ? tries.between(target) : std::nullopt;
  }
  if (missed) return aimed_lower(target, aimed, mapped);
  return uses_rest ? aimed_higher(target, mapped) : std::nullopt;
}

/// `vertex`: as seam_length has it.
bool is_better(const Mapped& a, const Mapped& b, const SeamTarget& target,
               const std::vector<Index>& vertex) {
  if (a.broken != b.broken) return a.broken < b.broken;
  if (misses(a, target) || misses(b, target)) {
    return excess_of(a.energy, target) < excess_of(b.energy, target);
  }
  return seam_length(a.opened.charts, vertex) < seam_length(b.opened.charts, vertex);
}

/// A few tries at the target, and a short cut where all of them miss it.
Mapped map_for_target(const Task& task, const SurfacePiece& piece, const SeamTarget& target,
                      const Work& work, std::vector<StageStatistics>& stages) {
  const SearchEffort effort = effort_for(task, piece, work.aside());
  const std::vector<Index>& vertex = task.admitted.input_vertex;
  std::optional<SeamTarget> aim = target;
  BegunSearch begun;
  std::optional<Mapped> best;
  Tries tries;
  const int most = effort.tries;
  for (int i = 0; i < most && aim && !work.out_of_time(); ++i) {
    const double from = i == 0 ? 0 : kFirstTry + (kSearched - kFirstTry) * (i - 1) / (most - 1);
    const double to = kFirstTry + (kSearched - kFirstTry) * i / (most - 1);
    const auto open = [&](const Work& inner) {
      return open_searched(piece, *aim, effort, task.options.weights, begun, inner);
    };
    Mapped mapped = open_and_map_once(task, open, false, work.part(from, to), stages);
    begun = std::move(mapped.opened.search);
    tries.add(aim->energy, mapped.energy.symmetric_dirichlet, misses(mapped, target));
    aim = aimed_again(target, *aim, mapped, tries, effort.uses_rest);
    if (!best || is_better(mapped, *best, target, vertex)) best = std::move(mapped);
  }
  if (best && !misses(*best, target)) return *std::move(best);
  const auto open = [&](const Work& inner) { return open_short(piece, inner); };
  Mapped shorter = open_and_map_once(task, open, false, work.part(kSearched, 1), stages);
  return best && !is_better(shorter, *best, target, vertex) ? *std::move(best) : std::move(shorter);
}

/// Splits what cannot be mapped within reason, round after round, until all can.
void rescue(const Task& task, const Work& work, std::vector<StageStatistics>& stages,
            Mapped& mapped) {
  const AtlasOptions& options = task.options;
  if (!promises(options.chart)) return;  // a baseline is shown as it is
  if (!task.input.pins.empty() || (options.target && options.target->max_charts > 0)) return;
  const PolygonParts polygons{options.admit.polygons, options.diagonals};
  run_stage("flatten", work, stages, [&](StageStatistics&, const Work& inner) {
    bool is_any = false;
    while (split_hopeless(task.admitted, polygons, options.chart, inner.untimed(),
                          mapped.opened.charts, mapped.maps)) {
      is_any = true;
    }
    if (is_any) measure(inner, mapped);
  });
}

Mapped map_piece(const Task& task, const SurfacePiece& piece, const Work& work,
                 std::vector<StageStatistics>& stages) {
  const Work own = work.part(0, kMapped);
  Mapped mapped;
  if (task.options.target) {
    mapped = map_for_target(task, piece, *task.options.target, own, stages);
  } else {
    const auto open = [&](const Work& inner) { return open_short(piece, inner); };
    mapped = open_and_map_once(task, open, true, own, stages);
  }
  rescue(task, work.part(kMapped, 1), stages, mapped);
  return mapped;
}

/// A piece that is congruent to another, whose maps are known: along the seams of that, unless they
/// miss the target here alone.
Mapped map_likewise(const Task& task, const SurfacePiece& piece, const SurfacePiece& like,
                    const Mapped& known, const Work& work, std::vector<StageStatistics>& stages) {
  const SeamTarget& target = *task.options.target;
  const auto open = [&](const Work& inner) {
    return open_along(piece, carried_marks(like, known.opened.seams, piece), inner);
  };
  Mapped mapped = open_and_map_once(task, open, false, work.part(0, kMapped), stages);
  if (misses(mapped, target) && !misses(known, target)) {
    return map_piece(task, piece, work, stages);
  }
  rescue(task, work.part(kMapped, 1), stages, mapped);
  return mapped;
}

/// Whether something is asked that pieces cannot be held to one by one.
bool is_asked_of_whole(const AtlasInput& input, const AtlasOptions& options) {
  if (!options.target) return true;  // nothing is
  return !input.pins.empty() || options.target->max_charts > 0 || options.target->seam_budget > 0 ||
         options.weights.symmetry > 0;
}

/// Large pieces one after the other on all threads, the rest side by side; `order`: their numbers.
/// `run(piece, work)`.
template <class Run>
void for_each_piece(const std::vector<SurfacePiece>& pieces, std::vector<Index> order,
                    const Work& work, const Run& run) {
  const auto faces = [&](Index p) -> std::int64_t { return pieces[p].surface.face_count(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return faces(a) > faces(b); });
  std::int64_t all = 0, done = 0;
  for (const Index p : order) all += faces(p);
  const auto share = [&](std::int64_t of) {
    return static_cast<double>(of) / static_cast<double>(all);
  };
  std::int64_t large = 0;
  // Others would wait for a piece of more than a thread's share. One thread takes all in turn.
  for (; large < size_of(order); ++large) {
    const Index p = order[large];
    if (work.threads() > 1 && faces(p) * work.threads() < all - done) break;
    run(p, work.part(share(done), share(done + faces(p))));
    done += faces(p);
  }
  std::atomic<std::int64_t> mapped{done};
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(work, size_of(order) - large, 1, [&](std::int64_t i, std::int64_t) {
    const Index p = order[large + i];
    run(p, work.aside());
    mapped += faces(p);
    if (std::this_thread::get_id() == caller) work.report(share(mapped));
  });
}

/// The stages of pieces that ran side by side, one of each name, in all the time that they took.
void add_up(const std::vector<std::vector<StageStatistics>>& of_pieces, double seconds,
            double cpu_seconds, std::vector<StageStatistics>& stages) {
  std::vector<StageStatistics> sums = {{"cut"}, {"flatten"}};
  double all = 0;
  for (const auto& own : of_pieces) {
    for (const StageStatistics& stage : own) {
      sums[std::string_view(stage.name) == "cut" ? 0 : 1].seconds += stage.seconds;
      all += stage.seconds;
    }
  }
  for (StageStatistics& sum : sums) {
    const double share = all > 0 ? sum.seconds / all : 0;
    sum.seconds = share * seconds;
    sum.cpu_seconds = share * cpu_seconds;
    stages.push_back(sum);
  }
}

/// The charts of a piece, in the unit of the whole.
void collect(const SurfacePiece& piece, const std::optional<SeamTarget>& target, Mapped mapped,
             const Admitted& admitted, MappedSurface& all) {
  const AtlasEnergy& energy = mapped.energy;
  if (target && (energy.symmetric_dirichlet > target->energy + kEnergyTolerance ||
                 misses(energy.p99, target->p99))) {
    Index first = first_input_face(mapped.opened.charts.front(), admitted);
    for (const AtlasChart& chart : mapped.opened.charts) {
      first = std::min(first, first_input_face(chart, admitted));
    }
    all.missed.push_back(
        {first, piece.real_faces, mapped.energy.symmetric_dirichlet, mapped.energy.p99});
  }
  for (std::size_t c = 0; c < mapped.maps.size(); ++c) {
    AtlasChart& chart = mapped.opened.charts[c];
    scale_by_power(-piece.exponent, chart.chart.mesh.positions);
    scale_by_power(-piece.exponent, mapped.maps[c].uvs);
    chart.collapsed_into = {};
    chart.local_map = {};
    all.charts.push_back(std::move(chart));
    all.maps.push_back(std::move(mapped.maps[c]));
  }
}

}  // namespace

MappedSurface open_and_map(const AtlasInput& input, const Admitted& admitted, int exponent,
                           const AtlasOptions& options, const Work& work,
                           std::vector<StageStatistics>& stages) {
  Task task{input, admitted, options, exponent};
  MappedSurface all;
  std::vector<SurfacePiece> pieces;
  run_stage("cut", work.part(0, kReady), stages, [&](StageStatistics&, const Work& inner) {
    ReadySurface ready =
        make_ready(admitted, input.cuts, options.fill_limit,
                   {options.admit.polygons, options.diagonals}, input.hints, inner);
    all.filled_holes = ready.filled_holes;
    if (is_asked_of_whole(input, options)) {
      pieces.push_back(std::move(ready.whole));
    } else {
      pieces = components_of(std::move(ready.whole), inner);
    }
  });
  for (const SurfacePiece& piece : pieces) task.area += area_of(piece, work.aside());
  std::vector<Mapped> mapped(pieces.size());
  std::vector<std::vector<StageStatistics>> spent(pieces.size());
  const double wall = wall_seconds(), cpu = cpu_seconds();
  std::vector<Index> first(pieces.size()), searched, copies;
  std::iota(first.begin(), first.end(), 0);
  if (options.target) first = first_congruent(pieces);
  for (Index p = 0; p < size_of(pieces); ++p) (first[p] == p ? searched : copies).push_back(p);
  const double share = kReady + (1 - kReady) * static_cast<double>(searched.size()) /
                                    static_cast<double>(pieces.size());
  for_each_piece(
      pieces, searched, work.part(kReady, share).named("cut"),
      [&](Index p, const Work& own) { mapped[p] = map_piece(task, pieces[p], own, spent[p]); });
  for_each_piece(pieces, copies, work.part(share, 1).named("cut"), [&](Index p, const Work& own) {
    mapped[p] = map_likewise(task, pieces[p], pieces[first[p]], mapped[first[p]], own, spent[p]);
  });
  add_up(spent, wall_seconds() - wall, cpu_seconds() - cpu, stages);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!mapped[p].pins.aside.empty()) all.pins_aside = std::move(mapped[p].pins.aside);
    collect(pieces[p], options.target, std::move(mapped[p]), admitted, all);
  }
  sort_by_first_face(admitted, all.charts, all.maps);
  return all;
}

}  // namespace beltrami
