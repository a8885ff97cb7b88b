// Cheapest ways to the seams and borders that there are.
#pragma once

#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "base/types.h"
#include "mesh/surface.h"

namespace beltrami {

/// A path of edges that are no seams, from a vertex off the seams and borders to the first that is
/// on them.
struct SeamPath {
  std::vector<Index> halfedges;  ///< in order
  std::vector<Index> vertices;   ///< that it adds to those of the seams: all but the last
  double cost = 0;
};

/// The forest of cheapest paths: Dijkstra's algorithm.
class SeamPaths {
 public:
  /// `is_root`: per vertex, whether it is on a seam or border; `cost`: per half-edge, infinite
  /// where no path may go. Paths that cost more than `bound` are not looked for, nor any once one
  /// has reached a `goal` (per vertex; null: there is none). Keeps references to `surface` and
  /// `cost`.
  SeamPaths(const Surface& surface, const std::vector<bool>& is_root,
            const std::vector<double>& cost, double bound, const std::vector<bool>* goal = nullptr);

  /// The goal that was reached first, or kNone.
  Index reached() const { return reached_; }

  /// The paths when these are roots, too.
  void add_roots(std::span<const Index> vertices);

  /// Per vertex, infinite where no path leads.
  const std::vector<double>& costs() const { return costs_; }
  SeamPath from(Index vertex) const;

 private:
  using Entry = std::pair<double, Index>;
  using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;
  void grow(Queue& queue, const std::vector<bool>* goal);

  const Surface& surface_;
  const std::vector<double>& cost_of_edge_;
  double bound_;
  std::vector<double> costs_;
  std::vector<Index> towards_;  ///< per vertex a half-edge at it, of its way, or kNone
  Index reached_ = kNone;
};

}  // namespace beltrami
