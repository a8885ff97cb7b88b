// The faces on which the reduced flattening evaluates its energy.
#pragma once

#include <vector>

#include "base/types.h"
#include "baselines/reduced/meta_vertices.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

struct SampledFaces {
  std::vector<Index> faces;     ///< those at the meta vertices first, ascending; then the strata
  std::vector<double> weights;  ///< the area each stands for; they add up to the area of the mesh
};

/// All faces at meta vertices, each for itself, and strata of the others: these are lined up along
/// a space-filling curve and cut into runs of equal importance, and the face in the middle of each
/// run stands for it. Importance is area, in total worth `strata` runs, and more near the boundary,
/// graded with the distance to it down to the length of the straight pieces: without that meta
/// vertices that are dense in comparison with the strata would shape a boundary layer that nothing
/// measures. Deterministic. If there are fewer others than `strata`, all faces are taken.
SampledFaces sample_faces(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          const MetaVertices& metas, Index strata);

}  // namespace beltrami
