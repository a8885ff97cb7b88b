#include "ring/ring_predicates.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "exact/exact_number.h"
#include "exact/orientation.h"

namespace beltrami {
namespace {

template <class Number>
struct Offset {
  Number x, y;
  Offset(const Vec2& p, const Vec2& origin)
      : x(Number(p.x()) - Number(origin.x())), y(Number(p.y()) - Number(origin.y())) {}
};

int exact_side_of_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Offset<ExactNumber> p(a, d), q(b, d), r(c, d);
  const auto cross = [](const auto& s, const auto& t) -> ExactNumber {
    return s.x * t.y - s.y * t.x;
  };
  const auto lift = [](const auto& s) -> ExactNumber { return s.x * s.x + s.y * s.y; };
  return sign_of(lift(p) * cross(q, r) + lift(q) * cross(r, p) + lift(r) * cross(p, q));
}

/// 1 where d lies inside of the circle of the counter-clockwise triangle (a, b, c), 0 on it, -1
/// outside. Filtered as by Shewchuk 1997, stage A.
int side_of_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  constexpr double kRoundoff = 0x1p-53, kErrorBound = (10 + 96 * kRoundoff) * kRoundoff;
  // Between these, products that underflow are far below the roundoff.
  constexpr double kLeastSum = 0x1p-500, kGreatest = 0x1p200;
  const Offset<double> p(a, d), q(b, d), r(c, d);
  double greatest = 0, side = 0, sum = 0;
  const auto add = [&](const auto& s, const auto& t, const auto& u) {
    const double lift = s.x * s.x + s.y * s.y, left = t.x * u.y, right = t.y * u.x;
    greatest = std::max({greatest, std::abs(s.x), std::abs(s.y)});
    side += lift * (left - right);
    sum += lift * (std::abs(left) + std::abs(right));
  };
  add(p, q, r);
  add(q, r, p);
  add(r, p, q);
  if (greatest < kGreatest && sum > kLeastSum && std::abs(side) > kErrorBound * sum) {
    return side > 0 ? 1 : -1;
  }
  return exact_side_of_circle(a, b, c, d);
}

}  // namespace

bool lexicographically_less(const Vec2& a, const Vec2& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

void fail_ring(const std::string& sentence) {
  throw Error(Fault::kInternal, "The scaffold cannot be triangulated: " + sentence);
}

std::vector<Vec2> ring_points(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer) {
  if (inner.size() < 3 || outer.size() < 3) fail_ring("a polygon has fewer than three vertices.");
  std::vector<Vec2> points = inner;
  points.insert(points.end(), outer.begin(), outer.end());
  for (const Vec2& p : points) {
    if (!p.allFinite()) fail_ring("a coordinate is not finite.");
  }
  return points;
}

bool is_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int side = side_of_circle(a, b, c, d);
  if (side != 0) return side > 0;
  const auto smaller = [](const Vec2& p, const Vec2& q) {
    return lexicographically_less(p, q) ? p : q;
  };
  return lexicographically_less(smaller(c, d), smaller(a, b));
}

std::vector<Index> corners_of_convex(const std::vector<Vec2>& polygon) {
  // A closed polygon that only turns left and by less than half a turn goes around once exactly if
  // its edges change twice between lexicographically rising and falling.
  const Index n = size_of(polygon);
  std::vector<Index> corners;
  int changes = 0;
  for (Index i = 0; i < n; ++i) {
    const Vec2& before = polygon[i == 0 ? n - 1 : i - 1];
    const Vec2& after = polygon[i + 1 == n ? 0 : i + 1];
    const bool changes_here =
        lexicographically_less(before, polygon[i]) != lexicographically_less(polygon[i], after);
    const int turn = orientation(before, polygon[i], after);
    if (turn < 0 || (turn == 0 && changes_here) || polygon[i] == after) {
      fail_ring("the outer polygon is not convex at its vertex " + std::to_string(i) + ".");
    }
    changes += changes_here ? 1 : 0;
    if (turn > 0) corners.push_back(i);
  }
  if (changes != 2) fail_ring("the outer polygon winds around more than once.");
  return corners;
}

}  // namespace beltrami
