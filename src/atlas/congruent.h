// Pieces of one shape, whose seams need be searched once.
#pragma once

#include <vector>

#include "atlas/open.h"
#include "base/types.h"
#include "cut/edge_marks.h"

namespace beltrami {

/// Per piece the first one that it is congruent to, itself where there is none: by a rigid motion,
/// or one and a reflection, whatever the order of vertices and faces, so that locked edges and
/// borders of labels fall on such. Lengths may differ by what single-precision places far from
/// the origin are off by. Pieces with paint are congruent to none.
std::vector<Index> first_congruent(const std::vector<SurfacePiece>& pieces);

/// Marks of a piece on one that it is congruent to, which first_congruent found.
EdgeMarks carried_marks(const SurfacePiece& from, const EdgeMarks& marks, const SurfacePiece& to);

}  // namespace beltrami
