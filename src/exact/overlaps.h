// Which triangles lie on each other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "exact/uv_boundary.h"

namespace beltrami {

struct Overlaps {
  /// Pairs of faces, one of which at least is at the boundary, whose interiors have a point in
  /// common.
  std::int64_t faces = 0;
  /// Pairs of boundary edges, as corners (see UvEdge), whose interiors cross, or that lie on each
  /// other in one direction.
  std::int64_t edges = 0;
  bool complete = true;                                        ///< all pairs were counted
  std::vector<std::array<Index, 2>> first_faces, first_edges;  ///< the lowest of them, in order
};

/// Finds the pairs of `suspect`, a face that overlaps another one, and those of the other faces at
/// the boundary: all of them where that takes no longer than O(n log n) and they are fewer than 4 n
/// or 65,536. Gives the first `most` of those found. Exact.
Overlaps list_overlaps(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary,
                       Index suspect, std::int64_t most, const Work& work);

}  // namespace beltrami
