// The cut that an atlas has, as edges of the input, and whether it is what was asked for.
#pragma once

#include <array>
#include <vector>

#include "atlas/types.h"
#include "base/types.h"
#include "cut/seam_target.h"

namespace beltrami {

/// The edges at which UVs part: that two sides of judged faces or more have, each without another
/// with the same UV vertices. By their ends as input_vertex numbers them, the lesser first, each
/// once and in order. What has one side is an open border.
std::vector<std::array<Index, 2>> seams_of(const Atlas& atlas);

/// What a search takes for met, and so what it is judged by.
inline constexpr double kEnergyTolerance = 1e-4;

/// Whether the atlas is injective and meets all that was asked of its seams: the energy to 1e-4, to
/// which they are searched for, and the number of charts but for one for each component.
bool meets(const Atlas& atlas, const SeamTarget& target);

}  // namespace beltrami
