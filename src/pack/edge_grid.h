// Edges of placed charts by the cells of a grid that they are near to.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "pack/outline.h"

namespace beltrami {

/// An edge of a chart.
struct ChartEdge {
  Index chart = kNone, edge = kNone;
};

/// Finds the edges within `reach` of a place on a page. Keeps nothing of what it is made from.
class EdgeGrid {
 public:
  EdgeGrid(const std::vector<PlacedOutline>& charts, double reach);

  /// Edges of which each has a point in the box of 2 reach per side about some point of the cell of
  /// `place`: among them all within `reach` of it. An edge may come more than once.
  std::span<const ChartEdge> near(Index page, const Vec2& place) const;

 private:
  std::int64_t cell_of(Index page, const Vec2& place) const;

  Vec2 low_{0, 0};
  double cell_ = 1;
  std::int64_t columns_ = 1, rows_ = 1;
  std::vector<std::int64_t> cells_;  // that have edges, increasing; empty: all have a list
  std::vector<Index> start_;         // per cell its first edge, and one more
  std::vector<ChartEdge> edges_;
};

}  // namespace beltrami
