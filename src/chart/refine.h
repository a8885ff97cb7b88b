// The paper's hybrid: composite majorization on the fine mesh, from the map of another mode.
#pragma once

#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"

namespace beltrami {

/// The stage "refine", in place. What it starts from is kept if it cannot be improved; a map that
/// is not injective is left alone. `mesh` is the disk whose faces the map has. Throws Error SOLVER.
void refine(const DiskMesh& mesh, const ChartOptions& options, const Work& work, ChartMap& map);

}  // namespace beltrami
