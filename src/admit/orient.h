// Faces glued across their edges, and turned to agree.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Half-edges 3 * face + corner, in pairs that may still run in the same direction.
struct Gluing {
  std::vector<Index> twin;        ///< per half-edge: the other one, or kNone
  Index crowded_edges = 0;        ///< of more than two faces of a layer
  bool joined_in_crowds = false;  ///< whether faces may be glued across such an edge
};

/// Glues the faces of a layer (one number per face) across edges that exactly two of them share,
/// and of a crowded edge the two of one polygon (one number per face, or none), then the sheets
/// that continue each other. Precondition: no face names a vertex twice.
Gluing glue(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
            const std::vector<Index>& layers, std::span<const Index> polygons, const Work& work);
/// The same of faces in the plane.
Gluing glue(const std::vector<Vec2>& uvs, const std::vector<Triangle>& faces,
            const std::vector<Index>& layers, std::span<const Index> polygons, const Work& work);

struct Orientation {
  std::vector<bool> reversed;  ///< per face
  Index one_sided_edges = 0;   ///< that were glued and no longer are
};

/// Turns faces, breadth first from the least one of each component, so that twins run against each
/// other, and most faces of a component stay as they are (the least one where it is half of them).
/// Where that is impossible, the edge parts. Turns a face (a, b, c) into (a, c, b), its half-edges
/// and those in `twin` with it. Polygons (one number per face, or none) stay in one piece. With
/// positions, a few faces that run against the rest of a component part from it instead.
Orientation orient(std::vector<Triangle>& faces, std::vector<Index>& twin,
                   std::span<const Index> polygons, const Work& work,
                   const std::vector<Vec3>* positions = nullptr);

}  // namespace beltrami
