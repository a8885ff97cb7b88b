// Beltrami coefficients of a coarse map and their prolongation to a fine mesh (paper section 3.3).
#pragma once

#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Beltrami coefficient mu = fzbar / fz of every face under `uvs`, in the frame whose real axis is
/// the face's edge from corner 0 to corner 1. |mu| < 1 where the face keeps its orientation; 0 where
/// the map is singular.
std::vector<Complex> beltrami_coefficients(const std::vector<Triangle>& faces,
                                           const std::vector<RestTriangle>& rest,
                                           const std::vector<Vec2>& uvs);

/// Carries one coefficient per coarse face over to the fine faces: averaged by area in the tangent
/// planes of the coarse vertices, interpolated at the point that is closest to each fine centroid,
/// and transported into the frame of the fine face. A convex combination throughout: |mu| never
/// exceeds the greatest coarse one. Faces without a normal get 0.
std::vector<Complex> prolong_coefficients(const DiskMesh& coarse,
                                          const std::vector<Complex>& coefficients,
                                          const DiskMesh& fine, int threads,
                                          const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
