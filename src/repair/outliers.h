// Cleaning outliers: a few faces of enormous energy that would block every global step.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Minimises the energy in patches of 3 rings around every face whose energy is above
/// max(20, 4 x mean), and around the faces `also`, in place, in up to three rounds, of which one
/// leaves alone the patches that gained little in the one before. A patch that moves boundary
/// vertices is taken back if it adds boundary crossings. Faces that are not positive are left
/// alone. Ends where the time is up. Returns the number of patches.
std::int64_t clean_outliers(Energy energy, const DiskMesh& mesh,
                            const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                            const std::vector<Index>& also, const Work& work);

}  // namespace beltrami
