// Costs of seams that lead paths astray: another start finds other seams.
#pragma once

#include <vector>

#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// Costs per half-edge, times smooth waves over the surface, which are the same wherever it is
/// moved to: one of a few ways for each `number`. Those of 0 are as given.
std::vector<double> costs_astray(const Surface& surface, const std::vector<double>& cost,
                                 int number, const Work& work);

}  // namespace beltrami
