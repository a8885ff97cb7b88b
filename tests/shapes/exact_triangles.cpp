#include "shapes/exact_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace beltrami::shapes {
namespace {

/// A sum of doubles that do not overlap, the least first: Shewchuk's expansions (1997).
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = x + parts_[i], part = sum - x;
      const double error = (x - (sum - part)) + (parts_[i] - part);
      if (error != 0) parts_[kept++] = error;
      x = sum;
    }
    parts_[kept++] = x;
    count_ = kept;
  }
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  int sign() const {
    const double top = parts_[count_ - 1];
    return top > 0 ? 1 : top < 0 ? -1 : 0;
  }

 private:
  std::array<double, 16> parts_{};
  std::size_t count_ = 1;
};

}  // namespace

int orientation(const Uv& a, const Uv& b, const Uv& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  // Shewchuk's bound of the rounding is 3.0001 units of this sum.
  const double bound =
      4 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
  if (left - right > bound) return 1;
  if (right - left > bound) return -1;
  ExactSum sum;
  sum.add_product(a[0], b[1]);
  sum.add_product(-a[1], b[0]);
  sum.add_product(b[0], c[1]);
  sum.add_product(-b[1], c[0]);
  sum.add_product(c[0], a[1]);
  sum.add_product(-c[1], a[0]);
  return sum.sign();
}

namespace {

/// Whether the line along a side of `a` has all of `b` on its other side.
bool parts(const UvTriangle& a, const UvTriangle& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Uv &p = a[k], &q = a[(k + 1) % 3];
    if (std::all_of(b.begin(), b.end(), [&](const Uv& x) { return orientation(p, q, x) <= 0; })) {
      return true;
    }
  }
  return false;
}

double least(const UvTriangle& t, std::size_t k) {
  return std::min({t[0][k], t[1][k], t[2][k]});
}
double most(const UvTriangle& t, std::size_t k) {
  return std::max({t[0][k], t[1][k], t[2][k]});
}

}  // namespace

bool overlap(const UvTriangle& a, const UvTriangle& b) {
  return !parts(a, b) && !parts(b, a);
}

std::optional<std::pair<std::size_t, std::size_t>> find_overlap(
    const std::vector<UvTriangle>& triangles) {
  std::vector<std::size_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return least(triangles[i], 0) < least(triangles[j], 0);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const UvTriangle& a = triangles[order[i]];
    const double right = most(a, 0), low = least(a, 1), high = most(a, 1);
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const UvTriangle& b = triangles[order[j]];
      if (least(b, 0) >= right) break;
      if (least(b, 1) >= high || most(b, 1) <= low) continue;
      if (overlap(a, b)) return std::pair{order[i], order[j]};
    }
  }
  return std::nullopt;
}

namespace {

double distance_to_segment(const Uv& p, const Uv& a, const Uv& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  double t = square > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square : 0;
  t = std::clamp(t, 0.0, 1.0);
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

}  // namespace

double distance(const Uv& a, const Uv& b, const Uv& c, const Uv& d) {
  const bool crossing = orientation(a, b, c) * orientation(a, b, d) < 0 &&
                        orientation(c, d, a) * orientation(c, d, b) < 0;
  if (crossing) return 0;
  return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d),
                   distance_to_segment(c, a, b), distance_to_segment(d, a, b)});
}

}  // namespace beltrami::shapes
