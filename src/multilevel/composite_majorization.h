// Composite majorization on a whole mesh: the method cm, and the coarse map of the others.
#pragma once

#include <vector>

#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/descent.h"
#include "multilevel/options.h"

namespace beltrami {

/// A start, then composite majorization to `tolerance`. Where it crawls at an enormous energy, from
/// a coarser mesh instead, and to the end where that crawls as well; the better map is kept. A
/// start with flips is returned as it is, its energy 0.
Descent minimise_from_scratch(const DiskMesh& mesh, double tolerance, const ChartOptions& options,
                              const Work& work);

}  // namespace beltrami
