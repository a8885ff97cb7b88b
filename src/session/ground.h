// The surface of an editing session, welded and triangulated once, and never changed.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"

namespace beltrami {

struct Ground {
  Admitted admitted;  ///< of about unit area
  int exponent = 0;   ///< it was scaled by that power of two
  std::vector<Triangle> input_faces;
  EdgeMarks inside;               ///< edges inside polygons, which are not to be cut; or none
  double fill_limit = 0.5;        ///< as AtlasOptions has it
  std::vector<Index> face_of;     ///< per face of the input that of the surface, or kNone
  std::vector<Index> polygon_of;  ///< per face of the input the caller's; none where it is that
  /// Half-edges by the ends of their edge, vertices of the input as they were welded, the lesser
  /// one first: in order, those of one edge next to each other.
  std::vector<std::pair<std::array<Index, 2>, Index>> edges;

  Index face_count() const { return admitted.surface.face_count(); }
  /// What the caller calls a face of the input: for messages.
  Index name_of(Index input_face) const {
    return polygon_of.empty() ? input_face : polygon_of[input_face];
  }
  /// The half-edges of an edge of the input; none where there is no such edge.
  std::vector<Index> halfedges_between(Index a, Index b) const;
  /// The corner of the input that corner k of a face of the surface is, 3 * face + corner.
  Index input_corner(Index face, int k) const {
    return 3 * admitted.input_face[face] + admitted.input_corner(face, k);
  }
  /// The other way round: 3 * face + corner of the surface, or kNone.
  Index own_corner(Index input_face, int corner) const;
};

/// Polygons: see PolygonParts; no spans are kept.
struct GroundOptions {
  AdmitOptions admit = {};
  double fill_limit = 0.5;
};

/// Throws what admit does.
Ground make_ground(const std::vector<Vec3>& positions, std::vector<Triangle> faces,
                   const GroundOptions& options, const Work& work);

}  // namespace beltrami
