// Taking spikes out of a map: faces so distorted that no step of the whole map makes sense.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Lowers the energy around the faces whose energy is above a limit, in place, in three rounds at
/// most: first vertex by vertex (sweep_vertices), which the worst of them need, then in regions
/// (relax_regions). Where these are more than a hundredth of all faces, around the worst of them.
/// `limit`: a symmetric Dirichlet energy; of other energies what compares to it. Returns the number
/// of faces of the first round, 0 where none is above the limit. Ends where the time is up.
/// Precondition: the faces of the mesh are positive; they stay so. `rest`: one entry per face,
/// `uvs`: one per vertex. Throws nothing of its own.
std::size_t relax_spikes(Energy energy, double limit, const DiskMesh& mesh,
                         const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                         const Work& work);

}  // namespace beltrami
