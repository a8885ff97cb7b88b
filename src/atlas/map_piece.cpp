#include "atlas/map_piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "atlas/aim.h"
#include "atlas/congruent.h"
#include "atlas/measure.h"
#include "atlas/pin_conflicts.h"
#include "atlas/rescue.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "cut/seam_costs.h"
#include "cut/seam_target.h"
#include "cut/search_effort.h"
#include "cut/search_seams.h"
#include "cut/unfold.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"

namespace beltrami {
namespace {

// Where these end in the progress.
constexpr double kMapped = 0.95;       // of a piece; what is left is to rescue charts
constexpr double kCut = 0.15;          // of opening along a short cut and mapping
constexpr double kFirstTry = 0.9;      // at a target that may be missed: most need no other
constexpr double kSearched = 0.98;     // then a short cut is tried
constexpr double kSearchedAll = 0.95;  // then creases are
/// A search for seams takes about as long as maps of so many faces, whatever it is made for.
constexpr double kSearchInFaces = 300'000;

/// The mean energy up to which a piece counts as flat. Stretches s are off by 3.5% then, in the
/// root of the mean square: an energy is about 2 + 2 (s1 - 1)^2 + 2 (s2 - 1)^2.
constexpr double kFlat = 2.005;
/// How many times as long as the seams along which a piece unfolds its creases may be, for it to be
/// tried: those of a cube are 1.7 times as long. Where searched seams miss their target, flat ones
/// that are longer than that have to leave no more charts than those, split where they need it: a
/// terrain of voxels would fall into thousands.
constexpr double kUnfolded = 3;
constexpr double kAnyLength = std::numeric_limits<double>::infinity();

/// Splits that are tried to bring a piece to its target which the search has missed. After the
/// first ones it is given up where those that are left would all have to be better than the best.
constexpr int kMostSplits = 8, kFirstSplits = 4;

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

/// One try: charts as `open(work)` makes them in a share `cut` of the time, and their maps.
template <class Open>
Mapped open_and_map_once(const Task& task, const Open& open, double cut, bool is_timed,
                         const Work& work, std::vector<StageStatistics>& stages) {
  Mapped mapped;
  run_stage("cut", work.part(0, cut), stages,
            [&](StageStatistics&, const Work& inner) { mapped.opened = open(inner); });
  const AtlasInput& input = task.input;
  std::vector<AtlasChart>& charts = mapped.opened.charts;
  mapped.pins = assign_pins(input.pins, input.faces, task.admitted, charts, task.exponent);
  require_no_conflict(charts, mapped.pins, input.pins);
  run_stage("flatten", work.part(cut, 1), stages, [&](StageStatistics&, const Work& inner) {
    mapped.maps =
        map_charts(charts, mapped.pins, task.options.chart, is_timed ? inner : inner.untimed());
    require_met(mapped.maps, input.pins);
    measure(inner, mapped);
  });
  return mapped;
}

bool misses(const Mapped& mapped, const SeamTarget& target) {
  return mapped.broken > 0 || exceeds(mapped.energy.symmetric_dirichlet, target.energy) ||
         exceeds(mapped.energy.p99, target.p99);
}

bool has_seams(const OpenedSurface& opened) {
  return std::find(opened.seams.begin(), opened.seams.end(), true) != opened.seams.end();
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

Mapped map_searched(const Task& task, const SurfacePiece& piece, const SeamTarget& target,
                    const Work& work, std::vector<StageStatistics>& stages);

/// A search with the holes of a piece open: where many are filled, the patches may bend what is
/// around them so that no seam brings it to the target. Nothing where it misses, too, where none is
/// filled, and where paint would have to be carried over.
std::optional<Mapped> map_with_open_holes(const Task& task, const SurfacePiece& piece,
                                          const SeamTarget& target, const Work& work,
                                          std::vector<StageStatistics>& stages) {
  const SeamHints& hints = piece.hints;
  const bool is_painted = !hints.vertex_paint.empty() || !hints.edge_paint.empty();
  if (piece.surface.face_count() == piece.real_faces || is_painted) return std::nullopt;
  SurfacePiece open = parted_along(piece, {}, 0, work.aside());
  open.hints.hard_angle = hints.hard_angle;
  if (!hints.labels.empty()) {
    open.hints.labels.assign(hints.labels.begin(), hints.labels.begin() + piece.real_faces);
  }
  Mapped mapped = map_searched(task, open, target, work, stages);
  if (misses(mapped, target)) return std::nullopt;
  EdgeMarks seams(piece.surface.twin.size(), false);
  for (Index h = 0; h < 3 * piece.real_faces; ++h) {
    if (mapped.opened.seams[h]) mark_edge(piece.surface, h, seams);
  }
  mapped.opened.seams = std::move(seams);
  mapped.opened.is_parted = true;
  return mapped;
}

/// A few tries at the target, the second one with open holes, and a short cut where all of them
/// miss it.
Mapped map_searched(const Task& task, const SurfacePiece& piece, const SeamTarget& target,
                    const Work& work, std::vector<StageStatistics>& stages) {
  const SearchEffort effort = effort_for(task, piece, work.aside());
  const std::vector<Index>& vertex = task.admitted.input_vertex;
  std::optional<SeamTarget> aim = target;
  BegunSearch begun;
  std::optional<Mapped> best;
  bool is_reached = false;
  const int most = effort.tries;
  const double cut = kSearchInFaces / (kSearchInFaces + piece.real_faces);
  const bool uses_rest = piece.real_faces >= effort.rest_faces;
  for (int i = 0; i < most && aim && !work.out_of_time(); ++i) {
    const double from = i == 0 ? 0 : kFirstTry + (kSearched - kFirstTry) * (i - 1) / (most - 1);
    const double to = kFirstTry + (kSearched - kFirstTry) * i / (most - 1);
    const auto open = [&](const Work& inner) {
      return open_searched(piece, *aim, effort, task.options.weights, begun, inner);
    };
    Mapped mapped = open_and_map_once(task, open, cut, false, work.part(from, to), stages);
    begun = std::move(mapped.opened.search);
    const double predicted = mapped.opened.predicted_energy;
    if (i == 0 && misses_by_far(excess_of(mapped.energy, target))) {
      const Work aside = work.part(to, to);
      std::optional<Mapped> open_holes = map_with_open_holes(task, piece, target, aside, stages);
      if (open_holes) return *std::move(open_holes);
    }
    if (misses(mapped, target)) {
      aim = is_reached ? std::nullopt : aimed_lower(target, *aim, predicted, mapped.energy);
    } else {
      // After a try that missed, or a further one, what is left is next to nothing.
      const bool is_worth_it = i == 0 && uses_rest && has_seams(mapped.opened);
      aim = is_worth_it ? aimed_higher(target, predicted, mapped.energy) : std::nullopt;
      is_reached = true;
    }
    if (!best || is_better(mapped, *best, target, vertex)) best = std::move(mapped);
  }
  if (best && !misses(*best, target)) return *std::move(best);
  const auto open = [&](const Work& inner) { return open_short(piece, inner); };
  Mapped shorter = open_and_map_once(task, open, kCut, false, work.part(kSearched, 1), stages);
  return best && !is_better(shorter, *best, target, vertex) ? *std::move(best) : std::move(shorter);
}

/// Of the marked edges.
double length_of(const Surface& surface, const EdgeMarks& marks) {
  double length = 0;
  for (Index h = 0; h < size_of(marks); ++h) {
    if (!marks[h]) continue;
    length +=
        std::sqrt((surface.positions[surface.target(h)] - surface.positions[surface.origin(h)])
                      .squaredNorm());
  }
  return length / 2;  // each has two half-edges
}

/// Per real face of a piece its corners in the map of its chart.
std::vector<std::array<Vec2, 3>> corners_of(const SurfacePiece& piece, const Mapped& mapped) {
  std::vector<std::array<Vec2, 3>> corners(piece.real_faces);
  const auto begin = piece.face.begin(), end = begin + piece.real_faces;
  for (std::size_t c = 0; c < mapped.maps.size(); ++c) {
    const AtlasChart& chart = mapped.opened.charts[c];
    for (Index f = 0; f < chart.real_faces; ++f) {
      const auto found = std::lower_bound(begin, end, chart.chart.input_face[f]);
      for (int k = 0; k < 3; ++k) {
        corners[found - begin][k] = mapped.maps[c].uvs[chart.chart.mesh.faces[f][k]];
      }
    }
  }
  return corners;
}

bool is_flat(const Mapped& mapped) {
  return mapped.broken == 0 && mapped.energy.symmetric_dirichlet < kFlat;
}

/// Cuts what is no disk of the real faces of a piece, which are `parted` along `seams`.
OpenedSurface open_parted(const SurfacePiece& piece, const EdgeMarks& seams,
                          const SurfacePiece& parted, const Work& work) {
  OpenedSurface opened = open_short(parted, work);
  EdgeMarks all = seams;
  for (Index h = 0; h < 3 * piece.real_faces; ++h) {
    if (opened.seams[h]) mark_edge(piece.surface, h, all);
  }
  opened.seams = std::move(all);
  opened.is_parted = true;
  return opened;
}

/// The edges of a piece that bound a hole of it which is filled where it is `parted`.
EdgeMarks filled_rims(const SurfacePiece& piece, const SurfacePiece& parted) {
  EdgeMarks rims(piece.surface.twin.size(), false);
  for (Index h = 0; h < 3 * piece.real_faces; ++h) {
    if (parted.surface.twin[h] >= 3 * piece.real_faces) mark_edge(piece.surface, h, rims);
  }
  return rims;
}

/// The charts between the creases of a piece, and as few as they unfold to; nothing where they are
/// not flat, or have no hope of seams that are no longer than `most`.
std::optional<Mapped> map_unfolded(const Task& task, const SurfacePiece& piece, double most,
                                   const Work& work, std::vector<StageStatistics>& stages) {
  const SurfacePiece real = parted_along(piece, {}, 0, work.aside());
  const EdgeMarks creases = creases_of(real.surface, real.locked);
  if (creases.empty() || length_of(real.surface, creases) > kUnfolded * most) return std::nullopt;
  EdgeMarks seams(piece.surface.twin.size(), false);
  std::copy(creases.begin(), creases.end(), seams.begin());
  SurfacePiece parted;
  const auto open = [&](const Work& inner) {
    parted = parted_along(piece, seams, task.options.fill_limit, inner.part(0, 0.5));
    return open_parted(piece, seams, parted, inner.part(0.5, 1));
  };
  Mapped apart = open_and_map_once(task, open, kCut, false, work.part(0, 0.5), stages);
  if (!is_flat(apart)) return std::nullopt;
  EdgeMarks all(creases.size());
  std::copy_n(apart.opened.seams.begin(), all.size(), all.begin());
  const EdgeMarks kept =
      unfolded(real.surface, std::move(all), filled_rims(piece, parted), corners_of(piece, apart));
  std::copy(kept.begin(), kept.end(), seams.begin());
  Mapped joined = open_and_map_once(task, open, kCut, false, work.part(0.5, 1), stages);
  return is_flat(joined) ? std::move(joined) : std::move(apart);
}

/// Splits what cannot be mapped within reason, round after round, until all can.
void rescue(const Task& task, const Work& work, std::vector<StageStatistics>& stages,
            Mapped& mapped) {
  const AtlasOptions& options = task.options;
  if (!promises(options.chart)) return;  // a baseline is shown as it is
  if (!task.input.pins.empty() || (options.target && options.target->max_charts > 0)) return;
  const PolygonParts& polygons = options.admit.polygons;
  run_stage("flatten", work, stages, [&](StageStatistics&, const Work& inner) {
    bool is_any = false;
    while (split_hopeless(task.admitted, polygons, beyond_reason(options.target), options.chart,
                          inner.untimed(), mapped.opened.charts, mapped.maps)) {
      is_any = true;
    }
    if (is_any) measure(inner, mapped);
  });
}

/// Marks the edges between charts as seams, too.
void mark_between_charts(const SurfacePiece& piece, OpenedSurface& opened) {
  std::vector<Index> chart_of_face(piece.face.size(), kNone);
  for (Index c = 0; c < size_of(opened.charts); ++c) {
    for (const Index face : opened.charts[c].chart.input_face) {
      const auto found = std::lower_bound(piece.face.begin(), piece.face.end(), face);
      chart_of_face[found - piece.face.begin()] = c;
    }
  }
  for (Index h = 0; h < size_of(opened.seams); ++h) {
    const Index twin = piece.surface.twin[h];
    if (twin != kNone && chart_of_face[h / 3] != chart_of_face[twin / 3]) opened.seams[h] = true;
  }
}

/// Splits the charts that exceed the target by most, one after the other, until the piece meets it:
/// the search finds no seam where all edges end at borders, as in a few long triangles. A piece
/// that so many splits do not bring there stays as it is.
void split_to_target(const Task& task, const SurfacePiece& piece, const SeamTarget& target,
                     const Work& work, std::vector<StageStatistics>& stages, Mapped& mapped) {
  const AtlasOptions& options = task.options;
  if (!promises(options.chart)) return;  // a baseline is shown as it is
  run_stage("flatten", work, stages, [&](StageStatistics&, const Work& inner) {
    Mapped trial = mapped;
    double best = 0;  // what a split has taken from the excess
    for (int split = 1; split <= kMostSplits && misses(trial, target); ++split) {
      const double before = excess_of(trial.energy, target);
      if (inner.out_of_time() ||
          !split_worst(task.admitted, options.admit.polygons, target.energy, options.chart,
                       inner.untimed(), trial.opened.charts, trial.maps)) {
        return;
      }
      measure(inner, trial);
      const double excess = excess_of(trial.energy, target);
      best = std::max(best, before - excess);
      if (split >= kFirstSplits && excess - 1 > (kMostSplits - split) * best) return;
    }
    if (misses(trial, target)) return;
    mark_between_charts(piece, trial.opened);
    mapped = std::move(trial);
  });
}

/// What is mapped along seams that were searched for, or else along creases, where that leaves
/// faces flat and the seams are not much longer.
Mapped map_for_target(const Task& task, const SurfacePiece& piece, const SeamTarget& target,
                      const Work& work, std::vector<StageStatistics>& stages) {
  Mapped searched = map_searched(task, piece, target, work.part(0, kSearchedAll), stages);
  if (misses(searched, target)) {
    rescue(task, work.part(kSearchedAll, kSearchedAll), stages, searched);
  }
  const bool missed = misses(searched, target);
  if (is_asked_of_whole(task.input, task.options) || work.out_of_time()) return searched;
  if (!missed && (target.flat_seams == 0 || is_flat(searched))) return searched;
  if (missed) {
    split_to_target(task, piece, target, work.part(kSearchedAll, kSearchedAll), stages, searched);
  }
  const std::vector<Index>& vertex = task.admitted.input_vertex;
  const double times = std::max(target.flat_seams, missed ? kUnfolded : 0);
  const double most = times * seam_length(searched.opened.charts, vertex);
  std::optional<Mapped> flat =
      map_unfolded(task, piece, missed ? kAnyLength : most, work.part(kSearchedAll, 1), stages);
  if (!flat || misses(*flat, target)) return searched;
  const bool is_simpler = missed && flat->maps.size() <= searched.maps.size();
  const bool is_short = seam_length(flat->opened.charts, vertex) <= most;
  return is_simpler || is_short ? *std::move(flat) : std::move(searched);
}

}  // namespace

double area_of(const SurfacePiece& piece, const Work& work) {
  return std::ldexp(surface_area(piece.surface, work), -2 * piece.exponent);
}

bool is_asked_of_whole(const AtlasInput& input, const AtlasOptions& options) {
  if (!options.target) return true;  // nothing is
  return !input.pins.empty() || options.target->max_charts > 0 || options.target->seam_budget > 0 ||
         options.weights.symmetry > 0;
}

Mapped map_piece(const Task& task, const SurfacePiece& piece, const Work& work,
                 std::vector<StageStatistics>& stages) {
  const Work own = work.part(0, kMapped);
  Mapped mapped;
  if (task.options.target) {
    mapped = map_for_target(task, piece, *task.options.target, own, stages);
  } else {
    const auto open = [&](const Work& inner) { return open_short(piece, inner); };
    mapped = open_and_map_once(task, open, kCut, true, own, stages);
  }
  rescue(task, work.part(kMapped, 1), stages, mapped);
  return mapped;
}

Mapped map_likewise(const Task& task, const SurfacePiece& piece, const SurfacePiece& like,
                    const Mapped& known, const Work& work, std::vector<StageStatistics>& stages) {
  const SeamTarget& target = *task.options.target;
  const auto open = [&](const Work& inner) {
    EdgeMarks seams = carried_marks(like, known.opened.seams, piece);
    if (!known.opened.is_parted) return open_along(piece, std::move(seams), inner);
    const SurfacePiece parted =
        parted_along(piece, seams, task.options.fill_limit, inner.part(0, 0.5));
    return open_parted(piece, seams, parted, inner.part(0.5, 1));
  };
  Mapped mapped = open_and_map_once(task, open, kCut, false, work.part(0, kMapped), stages);
  if (misses(mapped, target) && !misses(known, target)) {
    return map_piece(task, piece, work, stages);
  }
  rescue(task, work.part(kMapped, 1), stages, mapped);
  return mapped;
}

}  // namespace beltrami
