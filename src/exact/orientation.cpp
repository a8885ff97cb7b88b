#include "exact/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace beltrami {

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  return static_cast<int>(CGAL::orientation(
      Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()), Kernel::Point_2(c.x(), c.y())));
}

}  // namespace beltrami
