// Least cuts of graphs whose edges carry as much either way.
//
// Boykov & Kolmogorov, "An experimental comparison of min-cut/max-flow algorithms for energy
// minimization in vision" (PAMI 2004): a search tree from the sources and one from the sinks, both
// of which outlive the paths that they find.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"

namespace beltrami {

struct FlowEdge {
  Index one, other;
  double capacity;  ///< at least 0, finite
};

/// Where a node of a flow stands: at an end, or in between.
enum class Terminal : std::int8_t { kNeither, kSource, kSink };

/// Per node whether it is on the sources' side of a cut of least capacity: of all such cuts the one
/// nearest to the sinks. Capacities count to 2^-50 of their sum. No sources or sinks: all nodes are
/// on the sources' side. Precondition: one terminal for each node.
std::vector<bool> least_cut(const std::vector<Terminal>& terminals,
                            const std::vector<FlowEdge>& edges);

}  // namespace beltrami
