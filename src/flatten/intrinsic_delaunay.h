// Intrinsic Delaunay edge flips in a metric that is known by its cotangents alone (paper section
// 3.5.2).
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "flatten/laplacian.h"
#include "mesh/surface.h"

namespace beltrami {

struct DelaunayTriangulation {
  std::vector<Triangle> faces;         ///< the same vertices and boundary, as many faces
  std::vector<Cotangents> cotangents;  ///< of the new faces
  std::int64_t flips = 0;
  /// Edges that are not Delaunay and stay: their flip would join two neighbours a second time,
  /// which no list of triangles can hold. With none all weights of the Laplacian are >= 0.
  std::int64_t refused = 0;
};

/// Flips interior edges until every one is Delaunay: the cotangents of its two opposite angles sum
/// to at least zero. Only the conformal class of each face enters: at a flip both faces are scaled
/// to agree on their common edge, which makes the new cotangents a rational function of the old
/// ones (the formulas printed in the paper misplace a root). Ends after finitely many flips.
DelaunayTriangulation intrinsic_delaunay(const Surface& surface, std::vector<Cotangents> cotangents,
                                         const Work& work);

}  // namespace beltrami
