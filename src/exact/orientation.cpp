#include "exact/orientation.h"

#include <cmath>
#include <optional>

#include "exact/exact_number.h"

namespace beltrami {
namespace {

/// Of factors between these no part of an exact product leaves the range of numbers.
constexpr double kLeastFactor = 0x1p-450, kGreatestFactor = 0x1p450;

/// A sum of two doubles that do not overlap.
struct TwoSum {
  double high, low;
};

/// Knuth's two-sum.
TwoSum exact_sum(double a, double b) {
  const double high = a + b, part = high - a;
  return {high, (a - (high - part)) + (b - part)};
}

/// Dekker's product.
TwoSum exact_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const auto split = [](double x) -> TwoSum {
    const double big = kSplitter * x, high = big - (big - x);
    return {high, x - high};
  };
  const double high = a * b;
  const TwoSum s = split(a), t = split(b);
  return {high, s.low * t.low - (((high - s.high * t.high) - s.low * t.high) - s.high * t.low)};
}

/// The sign of s - t: that of the greatest part of the difference, parts of which do not overlap.
int sign_of_difference(const TwoSum& s, const TwoSum& t) {
  const TwoSum low = exact_sum(s.low, -t.low), middle = exact_sum(s.high, low.high);
  const TwoSum high = exact_sum(middle.low, -t.high), top = exact_sum(middle.high, high.high);
  for (const double part : {top.high, top.low, high.low, low.low}) {
    if (part != 0) return part > 0 ? 1 : -1;
  }
  return 0;
}

/// a - b, if that is a double.
std::optional<double> exact_difference(double a, double b) {
  const TwoSum sum = exact_sum(a, -b);
  if (sum.low != 0) return std::nullopt;
  return sum.high;
}

bool is_moderate(double factor) {
  const double size = std::abs(factor);
  return size == 0 || (size > kLeastFactor && size < kGreatestFactor);
}

/// Where all four differences are doubles, as where points are near each other or on a grid.
std::optional<int> orientation_of_exact_edges(const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto ax = exact_difference(a.x(), c.x()), ay = exact_difference(a.y(), c.y());
  const auto bx = exact_difference(b.x(), c.x()), by = exact_difference(b.y(), c.y());
  if (!ax || !ay || !bx || !by) return std::nullopt;
  for (const double d : {*ax, *ay, *bx, *by}) {
    if (!is_moderate(d)) return std::nullopt;
  }
  return sign_of_difference(exact_product(*ax, *by), exact_product(*ay, *bx));
}

int exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  if (!a.allFinite() || !b.allFinite() || !c.allFinite()) return 0;
  const ExactNumber cx(c.x()), cy(c.y());
  const ExactNumber left = (ExactNumber(a.x()) - cx) * (ExactNumber(b.y()) - cy);
  const ExactNumber right = (ExactNumber(a.y()) - cy) * (ExactNumber(b.x()) - cx);
  return sign_of(left - right);
}

}  // namespace

int orientation_beyond_filter(const Vec2& a, const Vec2& b, const Vec2& c) {
  if (a == b || b == c || c == a) return 0;  // common where UVs are unset
  if (const auto sign = orientation_of_exact_edges(a, b, c)) return *sign;
  return exact_orientation(a, b, c);
}

}  // namespace beltrami
