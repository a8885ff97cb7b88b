// Maps of what is flat already, or unfolds.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/options.h"

namespace beltrami {

/// Takes a flat start (descend/flat_start.h) instead of `uvs` where it is injective and has less
/// energy, with that of its contact: where parts are a rounding error apart, nothing moves. Returns
/// whether it is isometric but for slivers, and presses on itself or has slivers: then it is the
/// map, and a descent would bend it. `uvs` may have folds: then any flat start has less energy.
bool start_flat(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const ChartOptions& options, std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
