// Composite majorization on a whole mesh: the method cm, and the coarse map of the others.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/descent.h"
#include "chart/options.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Composite majorization on the whole mesh, as the stage `name`; from `start` where that serves,
/// see Inherited.
ChartMap cm_mode(const DiskMesh& mesh, const char* name, const std::vector<Vec2>& start,
                 const ChartOptions& options, const Work& work);

/// A start, then composite majorization to `tolerance`. Where it crawls at an enormous energy,
/// again from a coarser mesh; the better map is kept. A start with flips is returned as it is, its
/// energy 0.
Descent minimise_from_scratch(const DiskMesh& mesh, double tolerance, const ChartOptions& options,
                              const Work& work);

}  // namespace beltrami
