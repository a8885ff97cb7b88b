#include "atlas/open_and_map.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "atlas/measure.h"
#include "atlas/pin_conflicts.h"
#include "base/types.h"
#include "cut/edge_marks.h"
#include "cut/search.h"

namespace beltrami {
namespace {

// Where these end in the progress.
constexpr double kCut = 0.15;      // of opening and mapping
constexpr double kFirstTry = 0.6;  // at a target that may be missed

/// Missed by more, a target is worth further tries, so many in all, of large surfaces fewer;
constexpr double kMissed = 1e-6;
constexpr int kTries = 4, kFewTries = 2;
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

/// One try, at one target; `begun` as open_surface has it.
Mapped open_and_map_for(const AtlasInput& input, const Admitted& admitted, int exponent,
                        const std::optional<SeamTarget>& target, const AtlasOptions& options,
                        const BegunSearch& begun, const Work& work,
                        std::vector<StageStatistics>& stages) {
  Mapped mapped;
  OpenedSurface& opened = mapped.opened;
  run_stage("cut", work.part(0, kCut), stages, [&](StageStatistics&, const Work& inner) {
    opened = open_surface(admitted, input.cuts, options.fill_limit,
                          {options.admit.polygons, options.diagonals}, target, options.weights,
                          input.hints, begun, inner);
  });
  mapped.pins = assign_pins(input.pins, input.faces, admitted, opened.charts, exponent);
  require_no_conflict(opened.charts, mapped.pins, input.pins);
  run_stage("flatten", work.part(kCut, 1), stages, [&](StageStatistics&, const Work& inner) {
    mapped.maps = map_charts(opened.charts, mapped.pins, options.chart, inner);
    require_met(mapped.maps, input.pins);
    std::vector<ChartInfo> charts(opened.charts.size());
    mapped.energy = measure_charts(opened.charts, mapped.maps, 1, charts, inner);
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
  return misses(mapped.energy.symmetric_dirichlet, target.energy) ||
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
  const EdgeMarks& seams = mapped.opened.search.seams.seams;
  const bool is_cut = std::find(seams.begin(), seams.end(), true) != seams.end();
  if (!is_cut || target.p99 > 0 || fine > kUnused || coarse < kUsed) return std::nullopt;
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
                                      const Mapped& mapped, const Tries& tries, Index faces) {
  const bool missed = misses(mapped, target), is_small = faces <= kThoroughFaces;
  if (tries.missed && tries.reached) {
    return is_small && target.p99 == 0 ? tries.between(target) : std::nullopt;
  }
  if (missed) return aimed_lower(target, aimed, mapped);
  return is_small ? aimed_higher(target, mapped) : std::nullopt;
}

/// `vertex`: as seam_length has it.
bool is_better(const Mapped& a, const Mapped& b, const SeamTarget& target,
               const std::vector<Index>& vertex) {
  if (misses(a, target) || misses(b, target)) {
    return excess_of(a.energy, target) < excess_of(b.energy, target);
  }
  return seam_length(a.opened.charts, vertex) < seam_length(b.opened.charts, vertex);
}

}  // namespace

Mapped open_and_map(const AtlasInput& input, const Admitted& admitted, int exponent,
                    const AtlasOptions& options, const Work& work,
                    std::vector<StageStatistics>& stages) {
  const auto run = [&](const std::optional<SeamTarget>& target, const BegunSearch& begun,
                       const Work& part) {
    return open_and_map_for(input, admitted, exponent, target, options, begun, part, stages);
  };
  if (!options.target) return run(options.target, {}, work);
  const SeamTarget& target = *options.target;
  const Index faces = admitted.surface.face_count();
  std::optional<SeamTarget> aim = target;
  BegunSearch begun;
  std::optional<Mapped> best;
  Tries tries;
  const int most = faces <= kThoroughFaces ? kTries : kFewTries;
  for (int i = 0; i < most && aim && !(best && work.out_of_time()); ++i) {
    const double from = i == 0 ? 0 : kFirstTry + (1 - kFirstTry) * (i - 1) / (most - 1);
    const double to = kFirstTry + (1 - kFirstTry) * i / (most - 1);
    Mapped mapped = run(aim, begun, work.part(from, to));
    begun = mapped.opened.search;
    tries.add(aim->energy, mapped.energy.symmetric_dirichlet, misses(mapped, target));
    aim = aimed_again(target, *aim, mapped, tries, faces);
    if (!best || is_better(mapped, *best, target, admitted.input_vertex)) best = std::move(mapped);
  }
  return std::move(*best);
}

}  // namespace beltrami
