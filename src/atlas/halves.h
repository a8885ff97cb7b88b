// The two halves of what is symmetric, which can share their texels.
#pragma once

#include <array>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Edges, as two vertices of the input each, along which components part into a half and its mirror
/// image: those between faces on either side of the plane that the surface is symmetric to. None
/// of components that have a face across the plane, or one that is mirrored to no face;
/// none at all where the surface as a whole is not symmetric.
std::vector<std::array<Index, 2>> edges_between_halves(const Admitted& admitted, const Work& work);

}  // namespace beltrami
