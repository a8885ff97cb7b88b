#include "atlas/aim.h"

#include <algorithm>
#include <optional>

namespace beltrami {
namespace {

/// Missed by more, a target is worth further tries,
constexpr double kMissed = 1e-6;
/// which aim lower by so many times that,
constexpr double kMoreThanMissed = 1.1;
/// but at no less of the excess over 2: what is left then are wrinkles that no cut takes away.
constexpr double kLeastAim = 0.3;
/// Of the excess over 2 that a search aimed at: with more its coarse maps tell that it can do no
/// more, and its fine ones that open holes are worth a try; with less it has missed by a hair.
constexpr double kNearlyMet = 1.1;
/// Of the excess asked for, fine maps that use no more are worth a further try with shorter seams
/// if coarse ones used more; which aims at so much of it, and at no more than so many times it.
constexpr double kUnused = 0.96, kUsed = 0.9, kAim = 0.975, kMostAim = 2;

}  // namespace

bool exceeds(double energy, double target) {
  return target > 0 && energy > target + kMissed;
}

double excess_of(const AtlasEnergy& energy, const SeamTarget& target) {
  const double mean = (energy.symmetric_dirichlet - 2) / (target.energy - 2);
  return target.p99 > 0 ? std::max(mean, (energy.p99 - 2) / (target.p99 - 2)) : mean;
}

bool misses_by_far(double excess) {
  return excess > kNearlyMet;
}

std::optional<SeamTarget> aimed_lower(const SeamTarget& target, const SeamTarget& aimed,
                                      double predicted, const AtlasEnergy& energy) {
  const double mean = energy.symmetric_dirichlet, p99 = energy.p99;
  SeamTarget lower = target;
  if (exceeds(predicted, aimed.energy)) {
    if (misses_by_far((predicted - 2) / (aimed.energy - 2))) return std::nullopt;
    lower.energy -= kMoreThanMissed * (predicted - aimed.energy);
    return lower.energy < aimed.energy ? std::optional(lower) : std::nullopt;
  }
  if (exceeds(mean, target.energy)) lower.energy -= kMoreThanMissed * (mean - predicted);
  if (exceeds(p99, target.p99)) lower.p99 = aimed.p99 - kMoreThanMissed * (p99 - target.p99);
  const auto is_possible = [](double aim, double asked) {
    return asked == 0 || aim >= 2 + kLeastAim * (asked - 2);
  };
  const bool is_lower = lower.energy < aimed.energy || lower.p99 < aimed.p99;
  const bool all = is_possible(lower.energy, target.energy) && is_possible(lower.p99, target.p99);
  return is_lower && all ? std::optional(lower) : std::nullopt;
}

std::optional<SeamTarget> aimed_higher(const SeamTarget& target, double predicted,
                                       const AtlasEnergy& energy) {
  const double asked = target.energy - 2;
  const double coarse = (predicted - 2) / asked;
  const double fine = (energy.symmetric_dirichlet - 2) / asked;
  if (target.p99 > 0 || fine > kUnused || coarse < kUsed) return std::nullopt;
  if (kAim * coarse <= fine) return std::nullopt;  // no higher than what the search had
  SeamTarget higher = target;
  higher.energy = 2 + asked * std::min(kAim * coarse / fine, kMostAim);
  return higher;
}

}  // namespace beltrami
