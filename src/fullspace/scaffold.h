// Full-space optimisation that keeps the boundary simple: the map is surrounded by a triangulated
// scaffold that may not flip either (Jiang et al. 2017, SCAF; paper section 3.5).
#pragma once

#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "fullspace/newton.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Minimises the mean energy like minimise_energy, and never lets the boundary
/// meet itself: before each step the ring between the boundary and a circle around it is
/// triangulated anew, its faces, at rest as they lie, joining the energy with a small weight.
/// `energies` are the mesh's alone. `options.admissible` and `options.proxy_steps` are not used.
/// Precondition: `uvs` is injective. Throws Error SOLVER.
NewtonResult minimise_with_scaffold(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                    std::vector<Vec2>& uvs, const NewtonOptions& options,
                                    const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
