// A surface of flat and developable faces, as boxes and machined parts are -> seams along which it
// unfolds without distortion.
#pragma once

#include <array>
#include <vector>

#include "base/vectors.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Marks the creases of a surface whose faces are flat or developable between them; no marks where
/// there are no creases, or the surface is curved between them. `locked`: edges that are not to be
/// cut, or none.
EdgeMarks creases_of(const Surface& surface, const EdgeMarks& locked);

/// The marks but for the creases over which charts, laid one beside the other as they were mapped,
/// fit along their edges and do not overlap: the longest are taken back first. What is joined to a
/// disk stays one. `held`: marks that stay. `corners`: per face of the surface its corners in the
/// map of its chart. Precondition: area about 1.
EdgeMarks unfolded(const Surface& surface, EdgeMarks marks, const EdgeMarks& held,
                   const std::vector<std::array<Vec2, 3>>& corners);

}  // namespace beltrami
