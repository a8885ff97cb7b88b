// The ring around a polygon, triangulated: the scaffold that keeps a flattening from overlapping.
//
// A scaffold (Jiang, Schaefer, Panozzo 2017, "Simplicial complex augmentation framework for
// bijective maps") fills the space around the chart with triangles; as long as none of them
// inverts, the chart's boundary cannot cross itself.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

struct RingTriangulation {
  std::vector<Triangle> faces;  ///< counter-clockwise, indices into `points`
  std::vector<Vec2> points;     ///< the inner polygon's vertices, then the outer polygon's
};

/// The constrained Delaunay triangulation of the region between two polygons, without extra points.
/// `inner` is simple and counter-clockwise, `outer` is convex and counter-clockwise and `inner`
/// lies strictly inside it; both may have straight corners. Every face is positively oriented in
/// exact arithmetic, every polygon edge is an edge of exactly one face, and there are inner.size()
/// + outer.size() faces. The triangulation is unique: of four points on one circle the diagonal
/// through the lexicographically smallest is taken. O(n log n) expected, apart from adversarial
/// input. Throws Error INTERNAL if the polygons are not as described.
RingTriangulation triangulate_ring(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer);

/// "own" or "cgal": the back end is chosen when the library is built
/// (-DBELTRAMI_SCAFFOLD=own|cgal).
const char* ring_triangulation_name();

}  // namespace beltrami
