// What collapses did, so that what is found on the coarse surface can be carried to the fine one.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"

namespace beltrami {

/// Collapses in an order in which they may have happened, by the numbers of the fine vertices.
struct CollapseHistory {
  struct Step {
    Index vertex, target;
    std::array<Index, 2> apexes;  ///< third corners of the faces that went; kNone beyond a border
    Index first;                  ///< of its entries in `renamed`, up to those of the next step
  };

  std::vector<Step> steps;
  std::vector<Index> renamed;  ///< neighbours of the vertex that were none of the target's

  void append(const CollapseHistory& next);
};

/// The edges of the fine surface that `edges` of the coarse one became of, both by fine vertices:
/// undone in reverse, an edge of the target to a renamed vertex is one of the vertex, which is
/// joined to the target where seams, or what is kept, need it. What is cut along them has the same
/// topology: the same pieces, loops and handles. `on_border`: per fine vertex; `kept`: per fine
/// vertex whether ends of edges are to stay there, or none. In the order of their ends. Time:
/// linear.
std::vector<std::array<Index, 2>> carry_edges(const CollapseHistory& history,
                                              const std::vector<std::array<Index, 2>>& edges,
                                              const std::vector<bool>& on_border,
                                              const std::vector<bool>& kept);

}  // namespace beltrami
