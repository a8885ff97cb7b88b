// Where the search for seams is to aim next, so that the maps along them just meet a target.
#pragma once

#include <optional>

#include "atlas/types.h"
#include "cut/seam_target.h"

namespace beltrami {

/// Whether an energy is above a target by more than rounding; none is above 0.
bool exceeds(double energy, double target);

/// The excess over 2 by that which is asked for, of the mean or of the percentile.
double excess_of(const AtlasEnergy& energy, const SeamTarget& target);

/// Whether an excess, by the one that was aimed at, says that another aim is of no use: with more a
/// search can do no more, with less it has missed by a hair.
bool misses_by_far(double excess);

/// The target at which coarse maps would leave fine ones the energy that is asked for, if what
/// these have more stays; none where a cut cannot bring it. A search that aimed at `aimed` had
/// `predicted` in its coarse maps, and `energy` in the fine ones.
std::optional<SeamTarget> aimed_lower(const SeamTarget& target, const SeamTarget& aimed,
                                      double predicted, const AtlasEnergy& energy);

/// The target at which coarse maps would leave fine ones all of the energy that is allowed, where
/// these use less of it than the coarse ones did; none where that is not worth a further try.
std::optional<SeamTarget> aimed_higher(const SeamTarget& target, double predicted,
                                       const AtlasEnergy& energy);

}  // namespace beltrami
