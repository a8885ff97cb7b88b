// Polygons with holes in the plane, cut into triangles as CAD programs do it: without a vertex that
// is not a corner, and with slivers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shapes/random.h"
#include "shapes/shape.h"

namespace beltrami::shapes {

/// Integers of at most 2^20, so that orientations are exact.
using Point2 = std::array<std::int64_t, 2>;
using Loop = std::vector<Point2>;

/// What lies inside `outer` (counter-clockwise), and in no hole (counter-clockwise too). Loops are
/// simple, and holes touch nothing.
struct Region {
  Loop outer;
  std::vector<Loop> holes;
};

/// n points of an ellipse, counter-clockwise from the angle `phase` on.
Loop ellipse(const Point2& centre, double radius_x, double radius_y, int n, double phase);
Loop rectangle(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1);

/// The outer loop, then the holes turned round: the region is on the left of all.
std::vector<Loop> loops_of(const Region& region);

/// Triangles of indices into the points of loops_of(region), one loop after another: ears, the
/// first that is found from a random corner on, or the best-shaped.
std::vector<std::array<Vertex, 3>> tessellate(const Region& region, Random& random);

/// One polygon that runs along a hole as well, by a bridge that it has on both sides.
std::vector<Vertex> bridged(const Region& region);

/// The region at height z, in units of `unit`. Triangles, or for a region without holes one face.
Shape flat_shape(const Region& region, double unit, Random& random);

/// The solid between z = 0 and `height`; sides are quads or triangles. `taper`: the size of its
/// top.
struct Extrusion {
  double unit = 1;
  double height = 1;
  double taper = 1;
  int layers = 1;
  bool quads = false;
  bool lid = true;
};
Shape extrude(const Region& region, const Extrusion& how, Random& random);

}  // namespace beltrami::shapes
