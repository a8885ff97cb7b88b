// The baseline: the coarse UVs themselves carried over to the fine mesh (an extrinsic version of
// the baseline of the paper's Figure 6, which simplifies intrinsically). Flips faces.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Gives each fine vertex the UV of the coarse point that is closest to it, linear on coarse faces.
/// No guarantee of any kind: the reason for prolonging coefficients instead.
std::vector<Vec2> prolong_uvs(const DiskMesh& coarse, const std::vector<Vec2>& coarse_uvs,
                              const DiskMesh& fine, const Work& work);

}  // namespace beltrami
