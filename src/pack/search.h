// The density at which charts fill their pages, and the order in which they do.
#pragma once

#include "pack/problem.h"

namespace beltrami {

/// The largest density that is found at which all charts fit into the pages that there may be.
/// Throws Error INVALID_ARGUMENT where the margins alone take more than these. Precondition: no
/// chart is kept, and one has a length.
Packed pack_at_largest(const Problem& problem);

/// At a density. Throws Error INVALID_ARGUMENT where that does not fit.
Packed pack_at_density(const Problem& problem, double density);

}  // namespace beltrami
