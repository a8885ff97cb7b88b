// Seams at cheaper places that part the same.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Moves seams to cheaper places; what they part stays as it is: as many pieces, of the same loops
/// and handles. Arcs of seams between their nodes become shortest paths in narrow disks around
/// them that touch no other seam and no border, window after window, until nothing is gained. What
/// is marked costs no more than before. Nodes stay: vertices that other than two seams meet at,
/// that lie on the border, or that are anchored. `cost`: per half-edge, those of an edge alike,
/// positive and finite. `anchored`: per vertex, or none. `locked`: edges that no seam is moved to,
/// or none. Marked edges of the border stay marked. Time: some linear passes, and as the seams'
/// neighbourhood. Precondition: an arc that touches neither another one nor the border at either
/// end has two edges or more.
EdgeMarks straighten(const Surface& surface, const EdgeMarks& seams,
                     const std::vector<double>& cost, const std::vector<bool>& anchored,
                     const EdgeMarks& locked, const Work& work);

}  // namespace beltrami
