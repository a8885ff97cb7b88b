// Short cuts that make disks of any surface.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Marks a short cut graph for each component that is no disk: cut along it, every component is
/// one. A sphere is cut along a path of two edges or more between vertices far apart; boundary
/// loops are joined. Locked edges are not cut: diagonals of polygons, and what crosses a filled
/// hole. The greedy system of loops of Erickson & Whittlesey (SODA 2005), from the best of three to
/// six roots, the first of them all loops together. Time: as many shortest-path trees.
/// Where locked edges form loops in the dual, or part the vertices that have free ones, and leave
/// no cut, all edges of that component may be cut. Preconditions: `topology` is the surface's;
/// lengths far from the ends of the range of numbers.
EdgeMarks open_minimal(const Surface& surface, const Topology& topology, const EdgeMarks& locked,
                       const Work& work);

/// The marks, and those of a short cut graph of each piece that is no disk along them.
EdgeMarks opened_further(const Surface& surface, EdgeMarks marks, const EdgeMarks& locked,
                         const Work& work);

}  // namespace beltrami
