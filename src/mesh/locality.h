// Numbering vertices and faces by where they are, so that neighbours lie close in memory.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Points in the order of a Hilbert curve through their bounding box: the index of the first point,
/// of the second, and so on. Points in one cell (2^-11 of the longest side) keep their order.
/// Precondition: finite points.
std::vector<Index> along_hilbert_curve(const std::vector<Vec3>& points, const Work& work);

/// Faces by their least vertex: the index of the first face, of the second, and so on. Faces with
/// the same one keep their order. Precondition: indices in [0, vertex_count).
std::vector<Index> by_least_vertex(Index vertex_count, const std::vector<Triangle>& faces,
                                   const Work& work);

}  // namespace beltrami
