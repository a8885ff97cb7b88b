// The two halves of what is symmetric, which can share their texels.
#pragma once

#include <array>
#include <vector>

#include "admit/admit.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Edges, as two vertices of the input each, along which components part into halves of one shape:
/// those between faces on either side of the plane that the surface is symmetric to. None of
/// components that have a face across it, or halves that are not congruent; none at all where the
/// surface as a whole is not symmetric.
std::vector<std::array<Index, 2>> edges_between_halves(const AtlasInput& input,
                                                       const Admitted& admitted,
                                                       const AtlasOptions& options,
                                                       const Work& work);

}  // namespace beltrami
