// An embedding in integers: nothing rounds, so nothing folds.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// The straight-line drawing of de Fraysseix, Pach & Pollack (1990), in the linear time of Chrobak
/// & Payne (1995): with N vertices, integers in [0, 2N - 4] x [0, N - 2], times a power of two that
/// brings the drawing's area near the surface's. Injective for every disk, boundary included, in
/// exact arithmetic and in numbers of more than 1 + log2(N) bits; highly distorted.
std::vector<Vec2> grid_drawing(const DiskMesh& mesh);

}  // namespace beltrami
