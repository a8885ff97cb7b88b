#include "scaffold/ring_predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "base/error.h"
#include "exact/certificate.h"

namespace beltrami {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace

bool lexicographically_less(const Vec2& a, const Vec2& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

void fail_ring(const std::string& sentence) {
  throw Error(BELTRAMI_E_INTERNAL, "The scaffold cannot be triangulated: " + sentence);
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
  const auto point = [](const Vec2& p) { return Kernel::Point_2(p.x(), p.y()); };
  const auto side = CGAL::side_of_oriented_circle(point(a), point(b), point(c), point(d));
  if (side != CGAL::ON_ORIENTED_BOUNDARY) return side == CGAL::ON_POSITIVE_SIDE;
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
