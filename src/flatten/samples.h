// The faces on which the reduced flattening evaluates its energy.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

struct SampledFaces {
  std::vector<Index> faces;     ///< those at the given vertices first, ascending; then the strata
  std::vector<double> weights;  ///< the area each stands for; they add up to the area of the mesh
};

/// All faces at `vertices`, each for itself, and about `strata` of the others: these are lined up
/// along a space-filling curve and cut into runs of equal area, and the face in the middle of each
/// run stands for it. Deterministic. With `strata` at least the number of the others: all faces.
SampledFaces sample_faces(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          const std::vector<Index>& vertices, Index strata);

}  // namespace beltrami
