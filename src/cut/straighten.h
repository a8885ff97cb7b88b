// Seams at cheaper places that part the same.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Moves seams to cheaper places; what they part stays as it is: as many pieces, of the same loops
/// and handles. Arcs of seams between their nodes become shortest paths in narrow disks around
/// them that touch no other seam and no border, window after window. Nodes that three seams meet at
/// move to where the paths to the ends of their windows are shortest together, in disks likewise;
/// where more meet, two of them are led together before they reach it, as long as that is cheaper.
/// This goes on until next to nothing is gained. What is marked costs no more than before.
/// Vertices of seams stay, with as many seams, where they lie on the border, are anchored, or are
/// the loose end of one. `cost`: per half-edge, those of an edge alike, positive and finite.
/// `straightness`: where it is not 0, what costs less is judged with the turns along arcs, each as
/// Turning has it: seams may come to cost more without them.
/// `anchored`: per vertex, or none. `locked`: edges that no seam is moved to, or none. Marked edges
/// of the border stay marked. Time: some linear passes, and as the seams' neighbourhood.
/// Precondition: an arc that touches neither another one nor the border at either end has two edges
/// or more.
EdgeMarks straighten(const Surface& surface, const EdgeMarks& seams,
                     const std::vector<double>& cost, const std::vector<bool>& anchored,
                     const EdgeMarks& locked, double straightness, const Work& work);

}  // namespace beltrami
