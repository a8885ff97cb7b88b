// Short cuts that make disks of any surface.
#pragma once

#include <vector>

#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Marks a short cut graph for each component that is no disk: cut along it, every component is
/// one. A sphere is cut along a path of two edges or more between vertices far apart. Boundary loop
/// i of the topology counts as closed by a face if filled[i]; the others are joined to the cut.
/// The greedy system of loops of Erickson & Whittlesey (SODA 2005), from the best of three to six
/// roots, the first of them all joined loops together. Time: as many shortest-path trees.
/// Preconditions: `topology` is the surface's; one flag per loop, or none; lengths far from the
/// ends of the range of numbers. May mark edges of a filled loop.
EdgeMarks open_minimal(const Surface& surface, const Topology& topology,
                       const std::vector<bool>& filled, const Work& work);

}  // namespace beltrami
