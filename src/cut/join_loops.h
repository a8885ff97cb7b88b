// Pieces with several boundary loops -> disks.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Marks cheap paths that join the boundary loops of each piece that a disk is cut into along the
/// `marks`: a least spanning tree of the loops, of paths between the vertices nearest to each.
/// `cost` per half-edge, infinite where none may be marked. Returns whether all are joined.
bool join_loops(const Surface& disk, const std::vector<double>& cost, EdgeMarks& marks,
                const Work& work);

}  // namespace beltrami
