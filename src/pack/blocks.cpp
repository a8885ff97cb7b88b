#include "pack/blocks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/interrupt.h"
#include "pack/mask.h"
#include "pack/outline.h"

namespace beltrami {
namespace {

using Box = Eigen::AlignedBox2d;

/// The points of an edge and of a box that are nearest to each other: at an end of the edge or at a
/// corner of the box, unless they meet.
NearBlock nearest(const Vec2& p, const Vec2& q, const Box& block) {
  NearBlock best{p, p, HUGE_VAL};
  const auto consider = [&](const Vec2& on_edge, const Vec2& on_block) {
    const double distance = (on_edge - on_block).norm();
    if (distance < best.distance) best = {on_edge, on_block, distance};
  };
  for (const Vec2& end : {p, q}) consider(end, end.cwiseMax(block.min()).cwiseMin(block.max()));
  for (const auto corner : {Box::BottomLeft, Box::BottomRight, Box::TopLeft, Box::TopRight}) {
    const Vec2 at = block.corner(corner);
    consider(nearest_on(p, q, at), at);
  }
  return best;
}

}  // namespace

/// Calls visit(block) for those of its page that are within `reach` of what a chart covers.
template <class Visit>
void Blocks::for_each_within(const PlacedOutline& chart, double reach, const Visit& visit) const {
  Box box;
  for (const Vec2& p : chart.points) box.extend(p);
  if (box.isEmpty()) return;
  // Drawn from a corner of a block on, as its mask is: in a box of its own.
  const auto block_of = [&](double x) { return static_cast<int>(std::floor(x / cell_)); };
  const std::array<int, 2> low{block_of(box.min().x() - reach), block_of(box.min().y() - reach)};
  const int size =
      std::max(block_of(box.max().x() + reach) - low[0], block_of(box.max().y() + reach) - low[1]) +
      1;
  const Outline outline{chart.points, chart.edges, {}, 0, 0};
  const Mask mask =
      mask_at(outline, Vec2(1, 0), 1 / cell_, reach / cell_, Vec2(-low[0], -low[1]), size);
  const std::size_t of_page = static_cast<std::size_t>(chart.page) * cells_ * cells_;
  for (const Run& run : mask.runs) {
    const int row = low[1] + run.row;
    if (row < 0 || row >= cells_) continue;
    const int end = std::min(low[0] + run.end, cells_);
    for (int x = std::max(low[0] + run.begin, 0); x < end; ++x) {
      visit(of_page + static_cast<std::size_t>(row) * cells_ + x);
    }
  }
}

bool Blocks::take(const std::vector<PlacedOutline>& charts) {
  Index pages = 0;
  for (const PlacedOutline& chart : charts) pages = std::max(pages, chart.page + 1);
  std::vector<Index> owner(static_cast<std::size_t>(pages) * cells_ * cells_, kNone);
  owner_.resize(owner.size(), kNone);
  // Those that stay with their chart come before those that change hands.
  bool none_wanted = true;
  for (const bool are_own : {true, false}) {
    for (Index c = 0; c < size_of(charts); ++c) {
      poll_interrupt();
      for_each_within(charts[c], radius_, [&](std::size_t block) {
        if ((owner_[block] == c) != are_own) return;
        if (owner[block] == kNone) owner[block] = c;
        none_wanted = none_wanted && owner[block] == c;
      });
    }
  }
  owner_ = std::move(owner);
  return none_wanted;
}

std::vector<NearBlock> Blocks::near(const std::vector<PlacedOutline>& charts, Index chart,
                                    double reach) const {
  const PlacedOutline& outline = charts[chart];
  std::vector<NearBlock> found;
  const std::size_t of_page = static_cast<std::size_t>(cells_) * cells_;
  PollSometimes poll;
  for_each_within(outline, reach, [&](std::size_t block) {
    if (owner_[block] == kNone || owner_[block] == chart) return;
    const std::size_t at = block % of_page;
    const std::size_t column = at % cells_, row = at / cells_;
    const Vec2 corner = cell_ * Vec2(static_cast<double>(column), static_cast<double>(row));
    const Box box(corner, Vec2(corner + Vec2::Constant(cell_)));
    NearBlock best{Vec2::Zero(), Vec2::Zero(), HUGE_VAL};
    for (const auto& [from, to] : outline.edges) {
      poll();
      const NearBlock next = nearest(outline.points[from], outline.points[to], box);
      if (next.distance < best.distance) best = next;
    }
    if (best.distance <= reach) found.push_back(best);
  });
  return found;
}

}  // namespace beltrami
