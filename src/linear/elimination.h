// One order of elimination for many systems over parts of a mesh.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Per vertex of a mesh its rank in an order that leaves few fill-ins. Of a part of the mesh, cut
/// open along edges or with vertices taken out, it leaves few as well: what has no way through the
/// whole has none there.
std::vector<Index> elimination_ranks(const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& faces, const Work& work);

/// The rows of some vertices by their ranks; of equal ones the lesser vertex comes first. `rows`:
/// per vertex, or kNone where it has none. Without ranks nothing.
std::vector<int> in_order(std::span<const Index> ranks, const std::vector<Index>& rows);

}  // namespace beltrami
