// Which seams hold together what they join.
#pragma once

#include <vector>

#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Per half-edge, whether it is one of a seam without which the seams and the borders of `surface`
/// fall apart: it is on no cycle of them (Tarjan 1974). In time linear in the surface.
std::vector<bool> bridges(const Surface& surface, const EdgeMarks& seams);

}  // namespace beltrami
