// One chart after the other to the best place that is free.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "base/types.h"
#include "pack/mask.h"
#include "pack/page.h"

namespace beltrami {

/// What makes a place better than another.
enum class Rule {
  kLowest,  ///< its upper side is lower, then it is further left
  kCorner,  ///< its further side, upper or right, is nearer to the corner
};

/// Where a mask lies: its lower left cell.
struct Spot {
  Index page = kNone;
  int turn = 0;  ///< which of the chart's masks
  int x = 0, y = 0;
};

struct Layout {
  std::vector<Spot> spots;    ///< per chart
  Index failed = kNone;       ///< the first chart without a place, where the layout ended
  int width = 0, height = 0;  ///< in cells, what is taken of the pages from the corner on
  std::int64_t steps = 0;     ///< work done: words looked at
};

/// Which charts come first, and how some are to be turned.
struct Plan {
  std::vector<Index> order;
  std::vector<int> turns;  ///< per chart the mask that is taken, or kNone: the best; empty: all so
};

/// Nothing is placed further than so many cells from the corner, by what its rule looks at: no
/// limit but the page.
inline constexpr int kNoLimit = std::numeric_limits<int>::max() - 1;

/// Places the charts of a plan in its order, each on the first of the pages that has room for it:
/// those given, which may have taken cells, and up to `max_pages` copies of `empty`. `masks` are
/// per chart, one for each turn; a chart without any gets page 0. Pages in `spare` lend their
/// memory and get it back.
Layout place_in_order(const std::vector<std::vector<Mask>>& masks, const Plan& plan, Rule rule,
                      std::vector<Page> pages, const Page& empty, int max_pages,
                      std::vector<Page>& spare, int limit = kNoLimit);

}  // namespace beltrami
