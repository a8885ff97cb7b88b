// Vertices at one place, or nearly: what holds a triangle soup together.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Per position the least index of those that become one with it: equal positions (-0 is 0), and
/// those no further apart than `distance`, along chains too. The time is linear, unless so many lie
/// within the distance of each other that their cells of half its size touch in masses.
/// A distance below 2^-50 of the greatest coordinate counts as 0. Preconditions: positions finite;
/// the distance not negative.
std::vector<Index> weld(const std::vector<Vec3>& positions, double distance, const Work& work);

/// The same where nothing is welded.
std::vector<Index> each_its_own(Index count);

}  // namespace beltrami
