// A topological disk in flat arrays: the mesh type of every stage.
#pragma once

#include <vector>

#include "base/types.h"

namespace beltrami {

/// A triangulated disk. Half-edge h = 3 * face + k runs from corner k to corner k + 1 of its face.
/// Invariants (kept by build_disk): consistently oriented, edge- and vertex-manifold, connected,
/// one boundary loop, Euler characteristic 1, every vertex used by a face, positions finite.
struct DiskMesh {
  std::vector<Vec3> positions;    ///< one per vertex
  std::vector<Triangle> faces;    ///< corners counter-clockwise
  std::vector<Index> twin;        ///< per half-edge: the opposite one, or kNone on the boundary
  std::vector<Index> outgoing;    ///< per vertex: an outgoing half-edge; on the boundary the first
                                  ///< in counter-clockwise order (its own edge is a boundary edge)
  std::vector<Index> boundary;    ///< the boundary loop, the surface on its left
  std::vector<bool> on_boundary;  ///< per vertex

  Index vertex_count() const { return size_of(positions); }
  Index face_count() const { return size_of(faces); }
  Index origin(Index halfedge) const { return faces[halfedge / 3][halfedge % 3]; }
  Index target(Index halfedge) const { return faces[halfedge / 3][next_corner(halfedge % 3)]; }
  /// The next half-edge around the same face.
  static Index next(Index halfedge) { return halfedge % 3 == 2 ? halfedge - 2 : halfedge + 1; }
  static Index previous(Index halfedge) { return halfedge % 3 == 0 ? halfedge + 2 : halfedge - 1; }
  /// The next outgoing half-edge counter-clockwise around the same origin; kNone after the last
  /// face of a boundary vertex.
  Index rotate(Index halfedge) const { return twin[previous(halfedge)]; }

  /// Calls visit(half-edge) for each outgoing half-edge of `vertex`, counter-clockwise; each stands
  /// for one incident face. On the boundary the one-ring has one vertex more: the origin of the
  /// previous half-edge of the last face.
  template <class Visit>
  void for_each_outgoing(Index vertex, Visit&& visit) const {
    const Index first = outgoing[vertex];
    Index h = first;
    do {
      visit(h);
      h = rotate(h);
    } while (h != kNone && h != first);
  }
};

/// Builds the adjacency of a triangle list and proves that it is a disk.
/// Throws Error with a mesh status (EMPTY ... GENUS) and the offending element, as an index into
/// the arrays given. Every vertex must be used: see drop_unreferenced.
DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces, int threads = 1);

/// Renumbers `faces` in place over the vertices that they use, and returns these: per vertex that
/// is kept its index before, increasing. Precondition: indices in [0, vertex_count).
std::vector<Index> drop_unreferenced(Index vertex_count, std::vector<Triangle>& faces,
                                     int threads = 1);

/// Throws Error INDEX_OUT_OF_RANGE, REPEATED_VERTEX (the first such face) or EMPTY.
void validate_indices(Index vertex_count, const std::vector<Triangle>& faces, int threads = 1);

/// Throws Error NON_FINITE with the first such vertex.
void validate_positions(const std::vector<Vec3>& positions, int threads = 1);

/// Area of a triangle in space.
double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c);

/// Sum of the 3D areas of all faces.
double surface_area(const DiskMesh& mesh, int threads = 1);

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
                        int threads = 1);

}  // namespace beltrami
