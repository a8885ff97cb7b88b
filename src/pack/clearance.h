// How far apart charts lie, by their borders.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "pack/outline.h"
#include "pack/pack.h"

namespace beltrami {

/// The border of a chart where it lies.
struct PlacedOutline {
  Index page = 0;
  std::vector<Vec2> points;                 ///< in texels
  std::vector<std::array<Index, 2>> edges;  ///< as of an Outline
  bool stays = false;                       ///< it lies where it has to
};

PlacedOutline placed(const Outline& outline, const Placement& placement, double density);

/// The least distance between the borders of two charts of one page, 0 where they cross or one
/// lies on the other; `reach` where none is that near. The same for that to the edges of the page,
/// of `side` texels, negative outside of it. What stays is compared with neither its like nor the
/// page. Precondition: reach > 0, finite points.
struct Clearance {
  double charts = 0, page = 0;
};
Clearance clearance(const std::vector<PlacedOutline>& charts, double side, double reach);

}  // namespace beltrami
