// One order of elimination for many systems over parts of a mesh.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Per vertex of a mesh its rank in an order that leaves few fill-ins. It leaves few as well where
/// the mesh is cut open along edges, or vertices are taken out.
std::vector<Index> elimination_ranks(const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& faces, const Work& work);

/// The rows of some vertices by their ranks; of equal ones the lesser vertex comes first. `rows`:
/// per vertex, or kNone where it has none. Without ranks nothing.
std::vector<int> in_order(std::span<const Index> ranks, const std::vector<Index>& rows);

}  // namespace beltrami
