// The shrinking surface of the simplifier in flat arrays, compacted between passes.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"
#include "simplify/history.h"
#include "simplify/quadric.h"

namespace beltrami {

/// The boundary loops of a surface, each by its vertices, the surface on their left.
using VertexLoops = std::vector<std::vector<Index>>;

/// The surface between passes. Vertices and faces are compacted before each pass, in their order.
struct ShrinkingSurface {
  /// What a vertex is; a fixed one may be collapsed onto, but is never removed.
  enum class Role : std::uint8_t { kInterior, kBoundary, kFixedBoundary, kRemoved };

  /// What the cost of a collapse asks of its target: together, since the access is random.
  struct Site {
    Vec3 position;
    double error;  ///< of the vertex under its own quadric
  };

  std::vector<Site> site;
  std::vector<Quadric> quadric;
  std::vector<Role> role;
  std::vector<Index> loop_next, loop_previous;  ///< along the boundary; kNone inside
  std::vector<Index> fine_vertex;
  std::vector<Index> collapsed_into;  ///< per fine vertex: the next one on the way, or itself
  std::vector<Triangle> faces;        ///< a removed one has kNone as its first corner
  std::vector<Index> fine_face;       ///< per face, with the history
  Index live_faces = 0;
  std::vector<Index> loop_of;  ///< per fine vertex: the boundary loop, or kNone
  bool keeps_history = false;
  CollapseHistory history;
  std::vector<Index> loop_size, least_size;  ///< per loop: its vertices, and how many it keeps

  // Built for one pass.
  std::vector<Index> fan_start;      ///< per vertex: its first entry in `fan`
  std::vector<Index> fan;            ///< half-edges 3 * face + corner, by origin
  std::vector<Index> valence;        ///< live faces per vertex
  std::vector<Index> mark;           ///< scratch: the vertex whose ring was marked last
  std::vector<std::uint8_t> locked;  ///< bytes, since blocks write side by side

  Index vertex_count() const { return size_of(site); }
  const Vec3& position(Index v) const { return site[v].position; }
  bool on_boundary(Index v) const {
    return role[v] == Role::kBoundary || role[v] == Role::kFixedBoundary;
  }
  Index min_valence(Index v) const { return on_boundary(v) ? 2 : 3; }
  Index loop(Index v) const { return loop_of[fine_vertex[v]]; }
  /// Whether the loop of a boundary vertex can do without one.
  bool may_shorten(Index v) const { return loop_size[loop(v)] > least_size[loop(v)]; }

  /// Calls visit(face, corner, next vertex, previous vertex) for each live face of v.
  template <class Visit>
  void for_each_corner(Index v, Visit&& visit) const {
    for (Index i = fan_start[v]; i < fan_start[v + 1]; ++i) {
      const Index f = fan[i] / 3;
      const int k = fan[i] % 3;
      const Triangle& face = faces[f];
      if (face[0] != kNone) visit(f, k, face[next_corner(k)], face[previous_corner(k)]);
    }
  }

  template <class Visit>
  void for_each_neighbour(Index v, Visit&& visit) const {
    for_each_corner(v, [&](Index, int, Index a, Index) { visit(a); });
    if (on_boundary(v)) visit(loop_previous[v]);
  }
};

/// What every vertex is at the start. Fixed: the tips of ears, the ends of bridges, and one
/// boundary vertex between ends that follow each other on the loop.
std::vector<ShrinkingSurface::Role> vertex_roles(const Surface& mesh, const VertexLoops& loops);

/// How many vertices a boundary loop keeps: 8, or all it has.
Index least_boundary(Index loop_size);

/// Whether vertex_quadrics has the planes of the faces.
enum class FacePlanes { kIncluded, kLeftOut };

/// The quadric of each vertex at the start: the planes of its faces, weighted by area, and what
/// holds the boundary and faces without area in place.
std::vector<Quadric> vertex_quadrics(const Surface& mesh, FacePlanes planes, const Work& work);

/// The surface at the start: no pass begun yet.
ShrinkingSurface make_surface(const Surface& mesh, const VertexLoops& loops, const Work& work);

/// Drops removed faces and vertices, keeping the order of the others.
void compact(ShrinkingSurface& surface, const Work& work);

/// Compacts, lists the half-edges of each vertex and clears the state of the last pass.
void begin_pass(ShrinkingSurface& surface, const Work& work);

}  // namespace beltrami
