// Paths that go where others show the way.
#pragma once

#include <functional>
#include <vector>

#include "base/types.h"
#include "mesh/surface.h"

namespace beltrami {

/// Where a path may go.
struct PathRules {
  std::function<bool(Index)> ends;    ///< per vertex, whether it ends there
  std::function<bool(Index)> passes;  ///< per vertex, whether it may go on from there
};

/// The half-edges, in order, of the cheapest path from the first of the vertices that stays within
/// so many `rings` of all of them, to one where it ends; empty where there is none, or the first
/// one is such. `cost`: per half-edge, infinite where it may not go; it follows no border. Time: as
/// the neighbourhood of the vertices. Precondition: faces name the vertices.
std::vector<Index> path_beside(const Surface& surface, const std::vector<Index>& vertices,
                               int rings, const std::vector<double>& cost, const PathRules& rules);

}  // namespace beltrami
