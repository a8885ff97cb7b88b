// Any list of triangles as oriented manifold pieces: what every later stage works on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// Which faces of the input are parts of polygons, and where.
struct PolygonParts {
  std::span<const Index> polygon = {};  ///< per face, those of one polygon on end; or none
  /// Per face, bit k: its edge from corner k is inside its polygon; none: all are that lie between
  /// two of its faces.
  std::span<const std::uint8_t> diagonals = {};

  bool is_diagonal(Index face, int corner) const {
    return diagonals.empty() || (diagonals[face] >> corner & 1) != 0;
  }
};

struct AdmitOptions {
  /// Vertices no further apart become one, see weld; 0: those at one place; nothing: none.
  std::optional<double> weld_distance = 0;
  /// The first vertex of each body, increasing from 0: vertices of two are never made one; none:
  /// all are of one.
  std::span<const Index> bodies = {};
  /// Copies are no faces of the surface: they are to share what the first of them gets.
  bool share_copies = false;
  /// They stay in one piece. One that would be torn is a piece by itself; where a triangle of it
  /// has no area, as in one that crosses itself, the surface has a regular polygon of its area
  /// instead.
  PolygonParts polygons = {};
};

/// What was done to the input. Faces and vertices are the input's.
struct AdmitCounts {
  Index unused_vertices = 0;     ///< that no face names
  Index welded_vertices = 0;     ///< that became one with a vertex before them
  Index repeated_faces = 0;      ///< set aside: they name a vertex twice, after welding
  Index faces_without_area = 0;  ///< set aside: no more than 1e-14 of the largest face, or of the
                                 ///< square of their longest edge
  Index copies = 0;              ///< faces with the vertices of a face before them, either way
                                 ///< round: each lies in a layer of its own, or is shared
  Index crowded_edges = 0;       ///< of more than two faces of a layer, where only those stay
                                 ///< together that continue each other
  Index one_sided_edges = 0;     ///< where the sides of a one-sided surface part
  Index split_vertices = 0;      ///< that became several, one for each fan of faces
  Index reversed_faces = 0;      ///< turned over to agree with most faces of their component
  Index components = 0;
  Index closed_components = 0;  ///< without a boundary
  Index holes = 0;              ///< boundary loops but for the first of each component
};

/// The input as a surface. Corner k of its face f is corner input_corner(f, k) of the face
/// input_face[f] of the input. `admit` leaves its vertices and faces in the order of the input's;
/// they may be renumbered after it.
struct Admitted {
  /// A face with the vertices of another one.
  struct Copy {
    Index face, first;  ///< of the input
  };

  Surface surface;  ///< its vertices are fans of corners; all are used
  Topology topology;
  std::vector<Index> input_vertex;  ///< per vertex, the least of those welded
  std::vector<Index> input_face;    ///< per face
  std::vector<bool> reversed;       ///< per face of the surface
  std::vector<Index> set_aside;     ///< faces without area, which the surface lacks, increasing
  std::vector<Copy> copies;         ///< by their face
  std::vector<Index> welded_to;     ///< per vertex of the input, the least that it became one
                                    ///< with; empty where none did
  AdmitCounts counts;

  Index welded(Index input) const { return welded_to.empty() ? input : welded_to[input]; }
  int input_corner(Index face, int k) const { return reversed[face] ? (3 - k) % 3 : k; }
};

/// Makes oriented manifold pieces of any triangles: sets faces without area aside, glues faces
/// across edges that exactly two of a layer share, and those of more that continue each other,
/// orients each component breadth first, and gives each fan of faces a vertex of its own. Throws
/// Error EMPTY, INDEX_OUT_OF_RANGE, NON_FINITE, or ZERO_AREA where no face has any.
Admitted admit(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
               const AdmitOptions& options, const Work& work);

/// Whether an edge of the surface, by its half-edges, lies inside a polygon: not where a side of it
/// meets another side of the same. Precondition: polygons are given.
bool is_inside_polygon(const Admitted& admitted, const PolygonParts& polygons, Index h, Index twin);

/// Per face whether it has no area on the surface, as admit sets aside: no more than 1e-14 of the
/// largest face, or of the square of its longest edge, or a vertex named twice.
std::vector<bool> faces_without_area(const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& faces, const Work& work);

}  // namespace beltrami
