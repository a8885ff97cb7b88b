// Mending fold-overs: kernel fix, patch fix, global fix (paper section 3.5.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

struct RepairOptions {
  /// Whether a boundary that crosses itself is to be mended too.
  bool simple_boundary = false;
  /// Of so many faces left by rung 1, more are left to rung 3: where that is done, it is cheaper.
  std::size_t most_patches = 1000;
  int most_rings = 8;      ///< of a patch in rung 2
  bool global_fix = true;  ///< rung 3; it takes more memory than the others
};

struct RepairResult {
  std::int64_t flips_before = 0;  ///< faces that were not positive, by exact predicates
  std::int64_t flips_after = 0;
  std::int64_t kernel_fixes = 0;  ///< vertices moved into the kernel of their one-ring
  std::int64_t patch_fixes = 0;   ///< patches untangled
  std::int64_t global_fixes = 0;  ///< 1 if the whole layout was embedded anew
};

/// Mends every face of `uvs` that is not exactly positive, in place, by the paper's ladder: each
/// rung only where the one before failed.
///
/// 1. Kernel fix: an interior vertex of the face moves to the centroid of the kernel of its
///    one-ring polygon, if that leaves no near-zero area; in a second pass its neighbours move
///    first.
/// 2. Patch fix: injective untangling of 2, 4, 6, 8 rings, in which boundary vertices may move too
///    (an ear that became collinear cannot be mended otherwise); a patch is taken only if all its
///    faces are then positive and the boundary has no more crossings than before. Where it would
///    have more, again with the boundary held, and from a straight one. Of over 30 faces, but no
///    more than 2% of all, the regions within 4 rings come first, each untangled at once, and
///    those within 8 of what is left. Patches that are most of the mesh again and again end it.
/// 3. Global fix: see global_fix.h; taken if it leaves fewer faces that are not positive, or no
///    crossing where a simple boundary was asked for. What rounding folded in it goes through 1 and
///    2 again.
///
/// Never adds a flip, and a crossing only in 3 if no simple boundary was asked for.
RepairResult repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, const RepairOptions& options, const Work& work);

}  // namespace beltrami
