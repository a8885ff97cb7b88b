// Injective untangling of a small patch (after Garanzha et al. 2021, "Foldover-free maps in 50
// lines of code").
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Moves the vertices that are not `fixed` until every face is positive: Newton on the symmetric
/// Dirichlet energy with its barrier regularised, finite for flipped faces, while the
/// regularisation is tightened; then some steps on the energy itself. Returns whether all faces
/// came out exactly positive; `uvs` is changed only then.
bool untangle(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
              const std::vector<bool>& fixed, std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
