// The kernel of a polygon: the points from which all of it is visible.
#pragma once

#include <optional>
#include <vector>

#include "base/vectors.h"

namespace beltrami {

/// Area centroid of the kernel of a counter-clockwise polygon; nothing if the kernel has no area.
std::optional<Vec2> kernel_centroid(const std::vector<Vec2>& polygon);

}  // namespace beltrami
