// One disk -> one map: the only place that the ABI knows of this room, but for the estimate of
// memory.
#pragma once

#include "base/work.h"
#include "chart/flattening.h"
#include "mesh/disk_mesh.h"
#include "multilevel/inherited.h"
#include "multilevel/options.h"

namespace beltrami {

/// Flattens a disk that `normalise` has brought to about unit area; `frame` is what it returned.
/// Where the time of `work` is up, iterations end with the best map so far, NOT_CONVERGED. Throws
/// Cancelled, Error SOLVER or std::bad_alloc.
Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const ChartOptions& options,
                   const Work& work);

/// The same with what is known of the disk, in its numbers and its unit.
Flattening flatten(const DiskMesh& disk, const Normalisation& frame, const Inherited& inherited,
                   const ChartOptions& options, const Work& work);

}  // namespace beltrami
