// A topological disk in flat arrays: the mesh type of every stage that makes a map.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// A surface that is proven to be one disk: connected, one boundary loop, Euler characteristic 1,
/// every vertex used by a face.
struct DiskMesh : Surface {
  std::vector<Index> boundary;  ///< the vertices of the boundary loop, the surface on their left
};

/// Throws Error COMPONENTS, CLOSED, BOUNDARIES or GENUS with the offending element. Precondition:
/// every vertex is used by a face.
DiskMesh prove_disk(Surface surface, const Work& work);

/// Builds the adjacency of a triangle list and proves that it is a disk.
/// Throws Error with a mesh status (EMPTY ... GENUS) and the offending element, as an index into
/// the arrays given. Every vertex must be used: see drop_unreferenced.
DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work);

/// Renumbers `faces` in place over the vertices that they use, and returns these: per vertex that
/// is kept its index before, increasing. Precondition: indices in [0, vertex_count).
std::vector<Index> drop_unreferenced(Index vertex_count, std::vector<Triangle>& faces,
                                     const Work& work);

/// Area of a triangle in space.
double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Sum of the 3D areas of all faces.
double surface_area(const Surface& surface, const Work& work);

/// Where a mesh was before normalisation: normalised = (original - centre) * 2^exponent. The power
/// itself need not be a double: where coordinates are the least of numbers, it is beyond the
/// greatest.
struct Normalisation {
  Vec3 centre = Vec3::Zero();
  int exponent = 0;
};

/// Recentres the bounding box to the origin and scales by the power of two that brings the area
/// into [1/2, 2), or the box to a size of 2^40 where that is less: scaling the input by a power of
/// two then gives the same bits. Throws Error ZERO_AREA if the area is zero. Precondition: finite.
Normalisation normalise(std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        const Work& work);

}  // namespace beltrami
