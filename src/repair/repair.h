// Mending fold-overs: kernel fix, then patch fix (paper section 3.5.1).
#pragma once

#include <cstdint>
#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

struct RepairResult {
  std::int64_t flips_before = 0;  ///< faces that were not positive, by exact predicates
  std::int64_t flips_after = 0;
  std::int64_t kernel_fixes = 0;  ///< vertices moved into the kernel of their one-ring
  std::int64_t patch_fixes = 0;   ///< patches untangled
};

/// Mends every face of `uvs` that is not exactly positive, in place. First the kernel fix: an
/// interior vertex of the face moves to the centroid of the kernel of its one-ring polygon, if that
/// leaves no near-zero area. What remains is mended in patches of 2, 4, 6, 8 rings by injective
/// untangling, in which boundary vertices may move too (an ear that became collinear cannot be
/// mended otherwise); a patch is taken only if all its faces are then positive and the boundary has
/// no more crossings than before. Never adds a flip.
RepairResult repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, int threads,
                    const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
