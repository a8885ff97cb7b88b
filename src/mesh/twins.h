// The half-edges of a triangle list in pairs.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Per half-edge 3 * face + corner the one that runs against it, or kNone. Least is to be done
/// where the faces lie in the order of their least vertices, as `arrange` leaves them. Throws Error
/// NON_MANIFOLD_EDGE or ORIENTATION with the later face concerned, at the first edge with more than
/// two half-edges, or two in the same direction. Preconditions: indices in [0, vertex_count), no
/// face names a vertex twice.
std::vector<Index> pair_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                                  const Work& work);

}  // namespace beltrami
