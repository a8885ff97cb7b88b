// Cheapest ways to the seams and borders that there are.
#pragma once

#include <vector>

#include "base/types.h"
#include "cut/edge_marks.h"
#include "mesh/surface.h"

namespace beltrami {

/// A path of edges that are no seams, from a vertex off the seams and borders to the first that is
/// on them.
struct SeamPath {
  std::vector<Index> halfedges;  ///< in order
  std::vector<Index> vertices;   ///< that it adds to those of the seams: all but the last
  double cost = 0;
};

/// The forest of cheapest paths.
class SeamPaths {
 public:
  /// `is_root`: per vertex, whether it is on a seam or border; `cost`: per half-edge, infinite
  /// where no path may go. Dijkstra's algorithm.
  SeamPaths(const Surface& surface, const std::vector<bool>& is_root,
            const std::vector<double>& cost);

  /// Per vertex, infinite where no path leads.
  const std::vector<double>& costs() const { return cost_; }
  SeamPath from(Index vertex) const;

 private:
  const Surface& surface_;
  std::vector<double> cost_;
  std::vector<Index> towards_;  ///< per vertex a half-edge at it, of its way, or kNone
};

}  // namespace beltrami
