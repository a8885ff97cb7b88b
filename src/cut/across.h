// The cheapest path between the two borders of an annulus.
#pragma once

#include <vector>

#include "base/types.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// Of the piece that a half-edge's face is in, where seams and borders bound it: the half-edges of
/// the cheapest path from one of its two loops to the other, which makes a disk of it, if it is an
/// annulus. Empty if it has not two loops, or no path costs less than `bound`. `is_on`: per vertex,
/// whether a seam or border is there; `cost`: per half-edge, both of an edge alike. Time: n log n
/// of the piece, and n of the surface.
std::vector<Index> path_across(const Surface& surface, const EdgeMarks& seams,
                               const std::vector<bool>& is_on, Index halfedge,
                               const std::vector<double>& cost, double bound);

}  // namespace beltrami
