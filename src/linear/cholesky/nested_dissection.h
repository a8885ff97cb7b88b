// Elimination orders by nested dissection.
#pragma once

#include <span>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/graph.h"
#include "linear/spd_solver.h"

namespace beltrami {

/// Nested dissection (George 1973) by planes through `places`, one per vertex: near each plane the
/// smallest vertex separator is found as a minimum cut, and small parts are ordered by minimum
/// degree. Places that say nothing about the graph make the order worse, never wrong. Fastest where
/// vertices with numbers close together are close together: memory is walked in that order. The
/// same order at any number of threads. Precondition: places are finite.
std::vector<int> nested_dissection_order(const Graph& graph, std::span<const Place> places,
                                         const Work& work);

}  // namespace beltrami
