// What a chart covers, as its border.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "pack/types.h"

namespace beltrami {

/// The border of a chart with every face turned counter-clockwise, so that folds do not cancel:
/// the winding number of its edges about a point is the number of faces over it.
struct Outline {
  std::vector<Vec2> points;                 ///< those of the edges
  std::vector<std::array<Index, 2>> edges;  ///< directed, what is covered on their left
  std::vector<Vec2> hull;                   ///< convex, counter-clockwise; empty without edges
  double area = 0;                          ///< sum over the faces
  double length = 0;                        ///< of the edges
};

/// Takes linear time but for vertices of many edges. Precondition: finite points, indices in range.
Outline outline_of(const PackChart& chart);

/// The same of what the faces' edges are, directed, what is covered on their left; opposite ones
/// cancel, and may be missing. `area`: of the faces.
Outline outline_of(const std::vector<Vec2>& points, const std::vector<std::array<Index, 2>>& edges,
                   double area);

/// The border of a chart where it lies.
struct PlacedOutline {
  Index page = 0;
  std::vector<Vec2> points;                 ///< in texels
  std::vector<std::array<Index, 2>> edges;  ///< as of an Outline
  bool stays = false;                       ///< it lies where it has to
};

PlacedOutline placed(const Outline& outline, const Placement& placement, double density);

/// Leaves vertices out that lie within `width` of the edge that replaces theirs, so that no point
/// of the border is further from what is left of it. The hull stays what it is.
void thin(Outline& outline, double width);

/// The point of the segment p q that is nearest to a place.
Vec2 nearest_on(const Vec2& p, const Vec2& q, const Vec2& place);

/// The turn (cosine, sine) that lays the longer side of the hull's least box along x.
Vec2 turn_to_least_box(const std::vector<Vec2>& hull);

}  // namespace beltrami
