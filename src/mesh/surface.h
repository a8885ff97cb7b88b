// An oriented manifold in flat arrays: any number of components, handles and boundary loops.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// A triangulated surface. Half-edge h = 3 * face + k runs from corner k to corner k + 1 of its
/// face. Invariants (kept by build_surface): consistently oriented, edge- and vertex-manifold,
/// positions finite. A vertex that no face names belongs to no component.
struct Surface {
  std::vector<Vec3> positions;    ///< one per vertex
  std::vector<Triangle> faces;    ///< corners counter-clockwise
  std::vector<Index> twin;        ///< per half-edge: the opposite one, or kNone on the boundary
  std::vector<Index> outgoing;    ///< per vertex: an outgoing half-edge; on the boundary the first
                                  ///< in counter-clockwise order (its own edge is a boundary edge);
                                  ///< kNone where no face names the vertex
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
  /// The lesser half-edge of the same edge: what the edge is called by.
  Index edge(Index halfedge) const {
    const Index other = twin[halfedge];
    return other == kNone || halfedge < other ? halfedge : other;
  }

  /// Calls visit(half-edge) for each outgoing half-edge of `vertex`, counter-clockwise; each stands
  /// for one incident face. On the boundary the one-ring has one vertex more: the origin of the
  /// previous half-edge of the last face. Precondition: a face names the vertex.
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

/// Builds the adjacency of a triangle list and proves that it is an oriented manifold.
/// Throws Error EMPTY, INDEX_OUT_OF_RANGE, REPEATED_VERTEX, NON_FINITE, NON_MANIFOLD_EDGE,
/// ORIENTATION or NON_MANIFOLD_VERTEX with the element, as an index into the arrays given.
Surface build_surface(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work);

/// The same without the proof that the faces of each vertex form one fan: throws the same Errors
/// but NON_MANIFOLD_VERTEX. Where boundary edges leave a vertex in several directions, `outgoing`
/// is one of them.
Surface connect_faces(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work);

/// That proof: throws Error NON_MANIFOLD_VERTEX with the first vertex whose faces form several
/// fans.
void prove_fans(const Surface& surface, const Work& work);

/// The boundary loops, each by its half-edges in the order in which they follow each other, the
/// surface on their left. A loop starts at its least half-edge; loops come in the order of these.
struct BoundaryLoops {
  std::vector<Index> start;  ///< per loop its first entry in `halfedge`, and one more
  std::vector<Index> halfedge;

  Index count() const { return size_of(start) - 1; }
};
BoundaryLoops boundary_loops(const Surface& surface, const Work& work);

/// Per face, the least face that it is connected to.
std::vector<Index> connected_faces(const Surface& surface, const Work& work);

/// The number of edges, of a whole that has this many faces and boundary edges.
std::int64_t edge_count(std::int64_t faces, std::int64_t boundary_edges);

/// What a connected surface is, but for the way it lies in space.
struct Component {
  Index first_face = 0;  ///< the least one
  Index vertices = 0, faces = 0;
  Index boundary_edges = 0, loops = 0;

  std::int64_t euler() const { return vertices - edge_count(faces, boundary_edges) + faces; }
  Index genus() const { return static_cast<Index>((2 - loops - euler()) / 2); }
  bool is_disk() const { return loops == 1 && genus() == 0; }
};

/// The shape of a surface in the large.
struct Topology {
  std::vector<Component> components;  ///< by their least face
  std::vector<Index> component_of_face;
  std::vector<Index> component_of_loop;
  BoundaryLoops loops;
};
Topology topology_of(const Surface& surface, const Work& work);

/// Whether validate_indices refuses a face that names a vertex twice.
enum class RepeatedVertices { kRefused, kAllowed };

/// Throws Error INDEX_OUT_OF_RANGE, REPEATED_VERTEX (the first such face) or EMPTY.
void validate_indices(Index vertex_count, const std::vector<Triangle>& faces,
                      RepeatedVertices repeated, const Work& work);

/// Throws Error NON_FINITE with the first such vertex.
void validate_positions(const std::vector<Vec3>& positions, const Work& work);

}  // namespace beltrami
