// Polygons into triangles.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Faces of three corners and more.
struct Polygons {
  std::vector<Index> corners;  ///< the vertex of each corner, one face after another
  std::vector<Index> ends;     ///< per face the end of its corners; empty: all are triangles

  bool all_triangles() const { return ends.empty(); }
  Index count() const { return all_triangles() ? size_of(corners) / 3 : size_of(ends); }
  /// The corners of face i are those in [begin, end).
  Index begin(Index i) const { return all_triangles() ? 3 * i : (i > 0 ? ends[i - 1] : 0); }
  Index end(Index i) const { return all_triangles() ? 3 * i + 3 : ends[i]; }
};

struct Triangulation {
  /// Corners, as indices into Polygons::corners: n - 2 for n corners, those of one face after
  /// another, in its orientation. A triangle stays as it is.
  std::vector<Triangle> triangles;
  /// The first face that names a vertex twice, or that every way of cutting repeats an edge in; or
  /// kNone: the triangles form the surface that the polygons formed.
  Index first_repeating = kNone;
};

/// Cuts polygons into ears (Meisters 1975) in the plane of Newell's normal, the best-shaped ear
/// first, so that a planar simple polygon, convex or not, is covered once. A cut is never an edge
/// that the mesh has already, if there is a way. Where the two wishes conflict, or a polygon is not
/// planar and simple, the latter wins. The result depends on positions and polygons alone. Any
/// positions will do. Precondition: corners in range, three or more for each face.
Triangulation triangulate(const std::vector<Vec3>& positions, const Polygons& polygons,
                          const Work& work);

}  // namespace beltrami
