// The method beltrami, and those that flatten on the metric of the surface itself.
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/inherited.h"
#include "multilevel/options.h"

namespace beltrami {

/// In levels where the disk is large enough for them, else with one coarse mesh of `coarse_faces`
/// faces and the way to flatten that the options name. One UV per vertex. Throws Error SOLVER.
ChartMap beltrami_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                       const ChartOptions& options, const Work& work);

/// GIF or BFF, as the method says: the baselines without a coarse mesh.
ChartMap plain_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work);

}  // namespace beltrami
