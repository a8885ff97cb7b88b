#include "atlas/rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/types.h"

namespace beltrami {
namespace {

/// Gaps to the side of the square: of few boxes, and for each root of their number, so that what
/// thousands of gaps take together stays small.
constexpr double kGaps = 1024;
constexpr double kGapsPerRoot = 16;

}  // namespace

std::vector<Vec2> place_in_rows(const std::vector<Vec2>& sizes) {
  double area = 0, longest = 0;
  for (const Vec2& size : sizes) {
    area += size.prod();
    longest = std::max(longest, size.maxCoeff());
  }
  const double side = std::max(std::sqrt(area), longest);
  const double gap = side / (kGaps + kGapsPerRoot * std::sqrt(static_cast<double>(sizes.size())));
  double width = 0;
  for (const Vec2& size : sizes) width += (size + Vec2::Constant(gap)).prod();
  width = std::max(std::sqrt(width), longest);

  std::vector<Index> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return sizes[a].y() < sizes[b].y(); });
  std::vector<Vec2> corners(sizes.size());
  Vec2 next = Vec2::Zero();
  double row = 0;  // height, which grows
  for (const Index i : order) {
    const Vec2& size = sizes[i];
    if (next.x() > 0 && next.x() + size.x() > width) {
      next = {0, next.y() + row + std::min(gap, row)};
    }
    corners[i] = next;
    row = size.y();
    next.x() += size.x() + std::min(gap, size.maxCoeff());
  }
  return corners;
}

}  // namespace beltrami
