// The scaffold around a mesh: the circle that it ends at, its faces among those of the mesh, and as
// faces of an energy, with rest shapes and weights.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Corners are numbered through the polygon, then through the circle.
struct RingFaces {
  std::vector<Vec2> circle;        ///< the outer polygon, to be held fixed
  std::vector<Triangle> faces;     ///< counter-clockwise
  std::vector<RestTriangle> rest;  ///< each face at rest as it lies
  std::vector<double> weights;  ///< of the faces in an energy in which the mesh weighs `mesh_area`
};

/// `count` points, counter-clockwise, on the circle around the centre of the bounding box of
/// `inner`, whose radius is `factor` times half the diagonal of the box, or a little more where the
/// box is too small and far from the origin for so many points around it. Precondition: `inner` is
/// not empty. For the circle's polygon to contain `inner`, factor * cos(pi / count) > 1.
std::vector<Vec2> circle_around(const std::vector<Vec2>& inner, double factor, int count);

/// The circle at the outer end of every scaffold.
std::vector<Vec2> scaffold_circle(const std::vector<Vec2>& inner);

/// Appends the faces of a triangulated ring to those of the mesh whose boundary loop, numbered by
/// `boundary`, is its inner polygon. The points of its outer polygon are numbered from
/// `first_outer` on.
void glue_ring(const std::vector<Triangle>& ring, const std::vector<Index>& boundary,
               Index first_outer, std::vector<Triangle>& faces);

/// Triangulates the ring between a simple counter-clockwise polygon and a circle around it. Joined
/// to an energy that is infinite for flipped faces, it keeps the polygon from crossing itself
/// (Jiang et al. 2017, SCAF; paper section 3.5). Throws Error INTERNAL if the polygon is not as
/// described.
RingFaces ring_faces(const std::vector<Vec2>& polygon, double mesh_area);

}  // namespace beltrami
