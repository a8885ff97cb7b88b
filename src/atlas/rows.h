// Boxes side by side: where charts lie until a packer places them.
#pragma once

#include <vector>

#include "base/vectors.h"

namespace beltrami {

/// The lower left corners of boxes of these sizes, in rows of about the width of a square that
/// holds them all, a gap of about a thousandth of it between them. Low boxes come first, with no
/// more gap than they are high: thin ones lie near the axis, where numbers are dense.
std::vector<Vec2> place_in_rows(const std::vector<Vec2>& sizes);

}  // namespace beltrami
