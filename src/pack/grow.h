// Charts that grow until none can move any more.
#pragma once

#include <limits>

#include "pack/problem.h"

namespace beltrami {

/// Raises the density, up to `limit`, as far as charts that touch can push one another aside: cells
/// of a grid keep them about a cell further apart than the margin asks, and this gives it back, and
/// more. Each step grows all charts a little about their middles, collects where they are nearer
/// than the margin, and finds the least motions, turns included where any are allowed, that end
/// this to first order (projected Gauss-Seidel, as in rigid body dynamics; Lubachevsky and
/// Stillinger 1990 grow disks so). Charts that are kept stay as they are at the density `limit`,
/// and the others move around them; where there are blocks, charts move within those that are
/// theirs or free. What comes back keeps the margin by the distances of its own numbers, shares no
/// block, and is at least as dense. Leaves alone what has margins below a texel.
Packed grow(const Problem& problem, Packed packed,
            double limit = std::numeric_limits<double>::infinity());

}  // namespace beltrami
