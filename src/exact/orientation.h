// The exact predicate on which every verdict rests. The filter and what follows it are those of
// Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates": stage A, then stage B where that is exact, then numbers of any length.
#pragma once

#include <cmath>

#include "base/vectors.h"

namespace beltrami {

/// As orientation, for any points.
int orientation_beyond_filter(const Vec2& a, const Vec2& b, const Vec2& c);

/// Exact sign of the area of (a, b, c): 1 counter-clockwise, 0 collinear, -1 clockwise; 0 where a
/// coordinate is not finite.
inline int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  constexpr double kRoundoff = 0x1p-53;
  constexpr double kErrorBound = (3 + 16 * kRoundoff) * kRoundoff;
  constexpr double kLeastSum = 0x1p-960;  // products that underflow are far below its roundoff
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double area = left - right, sum = std::abs(left) + std::abs(right);
  // Written so that what overflows is left to the exact numbers.
  if (sum > kLeastSum && std::abs(area) > kErrorBound * sum) return area > 0 ? 1 : -1;
  return orientation_beyond_filter(a, b, c);
}

}  // namespace beltrami
