// The global fix of fold-overs: the layout and a scaffold around it, embedded together in a circle
// with positive weights (paper section 3.5.1).
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Glues a triangulated ring to the layout and places every vertex at the average of its neighbours
/// with the mean value weights of the present layout, angles taken without sign so that all weights
/// are positive, the outer circle held: an embedding in exact arithmetic, boundary included, from
/// any layout (Tutte 1963; Floater 2003). Where the layout is injective around a vertex it
/// satisfies the vertex's equation already, so that the map changes little away from its folds. A
/// boundary that crosses itself gets the ring of the boundary laid on a circle.
///
/// One unsymmetric system, solved by an iteration with the factor of a symmetric one near to it;
/// where it does not converge, that one's solution, an embedding as well, is taken. Returns false,
/// with `uvs` as they were, if the factorization fails in floating point; the caller checks what
/// rounding made of the rest.
bool embed_with_scaffold(const DiskMesh& mesh, std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
