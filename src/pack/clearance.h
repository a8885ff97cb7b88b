// How far apart charts lie, by their borders.
#pragma once

#include <vector>

#include "pack/outline.h"

namespace beltrami {

/// The least distance between the borders of two charts of one page, 0 where they cross or one
/// lies on the other; `reach` where none is that near. The same for that to the edges of the page,
/// of `side` texels, negative outside of it. What stays is compared with neither its like nor the
/// page. Precondition: reach > 0, finite points.
struct Clearance {
  double charts = 0, page = 0;
};
Clearance clearance(const std::vector<PlacedOutline>& charts, double side, double reach);

}  // namespace beltrami
