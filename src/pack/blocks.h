// Blocks of texels that belong to one chart each, while the charts move.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "pack/outline.h"

namespace beltrami {

/// A block that is near to a chart and no longer free for it.
struct NearBlock {
  Vec2 on_chart{0, 0}, on_block{0, 0};  ///< the points that are nearest to each other, in texels
  double distance = 0;                  ///< 0 where the chart covers a part of the block
};

/// Squares of texels on the grid of a page. A block is of the chart that came first within half the
/// margin of it, and free again once that is gone: charts that keep this distance from all blocks
/// of others share none, as in masks of cells that are blocks.
class Blocks {
 public:
  /// `radius` is half the margin, `cell` the side of a block, both in texels; `cells` are blocks
  /// per side of a page.
  Blocks(int cells, double cell, double radius) : cells_(cells), cell_(cell), radius_(radius) {}

  /// Gives blocks back that charts have left, then the free ones that they have come to, in the
  /// order of the charts. False where two want one.
  bool take(const std::vector<PlacedOutline>& charts);

  /// The blocks of others within `reach` texels of a chart, one entry each, in their order.
  std::vector<NearBlock> near(const std::vector<PlacedOutline>& charts, Index chart,
                              double reach) const;

 private:
  template <class Visit>
  void for_each_within(const PlacedOutline& chart, double reach, const Visit& visit) const;

  int cells_;
  double cell_, radius_;
  std::vector<Index> owner_;  // per page and block, kNone where it is free
};

}  // namespace beltrami
