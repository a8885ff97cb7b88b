// The boundary of a set of triangles by the indices of their UV vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Triangles in the plane with the signs of their areas; 0 leaves one out.
struct SignedTriangles {
  const std::vector<Triangle>& faces;  ///< indices of `uvs`
  const std::vector<Vec2>& uvs;
  std::vector<std::int8_t> signs;  ///< per face
};

/// A directed edge of a triangle, which lies on its left: `corner` 3 f + k stands for the edge of
/// face f between its corners k and k + 1.
struct UvEdge {
  Index from, to, corner;
  Index face() const { return corner / 3; }
};

struct UvBoundary {
  std::vector<UvEdge> edges;  ///< by their lower vertex, then the higher one, then the corner
  /// First edge with another one between the same vertices in the same direction, so that their
  /// triangles lie on each other; kNone if there is none. All between those vertices are in
  /// `edges`.
  Index first_doubled = kNone;
};

/// The edges that no triangle uses in the other direction, each triangle taken with its sign. As a
/// chain they are the sum of all the triangles' edges, if none is doubled. In linear time.
UvBoundary uv_boundary(const SignedTriangles& triangles, const Work& work);

/// A number per face, 0 and up in the order of the first faces: that of its chart, the faces
/// without sign left out (kNone). Faces that share two UV vertices are in one chart.
std::vector<Index> uv_charts(const SignedTriangles& triangles, const Work& work);

}  // namespace beltrami
