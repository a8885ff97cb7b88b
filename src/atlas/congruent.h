// Pieces of one shape, whose seams need be searched once.
#pragma once

#include <optional>
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

/// One piece laid onto another that it is congruent to.
struct Laid {
  std::vector<Index> onto;  ///< per half-edge of the one that of the other on the same edge
  bool reflected = false;   ///< these run the other way
};

/// How a piece lies on another by a rigid motion, or `mirrored` by one and a reflection where there
/// is no such; none where that is not found.
std::optional<Laid> laid_onto(const SurfacePiece& from, const SurfacePiece& to, bool mirrored);

/// Marks of a piece on one that it is congruent to, which first_congruent found.
EdgeMarks carried_marks(const SurfacePiece& from, const EdgeMarks& marks, const SurfacePiece& to);

}  // namespace beltrami
