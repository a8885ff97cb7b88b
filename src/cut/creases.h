// Edges at which the faces of a surface turn.
#pragma once

#include "base/types.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Whether the normals of the faces on both sides of an edge turn by more than the angle with this
/// cosine. Precondition: the half-edge has a twin.
bool is_crease(const Surface& surface, Index halfedge, double cosine);

/// Takes back the marks of creases that are trees and meet neither the border nor an edge that is
/// marked beside them: each would be a slit, of which only the search can tell whether it is worth
/// anything. `creases`: which of the marked edges may go.
void drop_slits(const Surface& surface, const EdgeMarks& creases, EdgeMarks& marks);

}  // namespace beltrami
