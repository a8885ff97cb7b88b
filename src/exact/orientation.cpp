// The filter is that of Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast
// robust geometric predicates", stage A.
#include "exact/orientation.h"

#include <cmath>

#include "exact/exact_number.h"

namespace beltrami {
namespace {

constexpr double kRoundoff = 0x1p-53;
constexpr double kErrorBound = (3 + 16 * kRoundoff) * kRoundoff;
constexpr double kLeastSum = 0x1p-960;  // products that underflow are far below its roundoff

int exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const ExactNumber cx(c.x()), cy(c.y());
  const ExactNumber left = (ExactNumber(a.x()) - cx) * (ExactNumber(b.y()) - cy);
  const ExactNumber right = (ExactNumber(a.y()) - cy) * (ExactNumber(b.x()) - cx);
  return sign_of(left - right);
}

}  // namespace

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double area = left - right, sum = std::abs(left) + std::abs(right);
  // Written so that what overflows is left to the exact numbers.
  if (sum > kLeastSum && std::abs(area) > kErrorBound * sum) return area > 0 ? 1 : -1;
  if (a == b || b == c || c == a) return 0;  // common where UVs are unset
  return exact_orientation(a, b, c);
}

}  // namespace beltrami
