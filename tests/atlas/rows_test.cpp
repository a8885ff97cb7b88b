#include "atlas/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace beltrami {
namespace {

std::vector<Vec2> some_sizes() {
  std::vector<Vec2> sizes;
  for (int i = 0; i < 200; ++i) sizes.emplace_back(1 + i * 7 % 13, 0.5 + i * 5 % 11);
  sizes.emplace_back(40, 2);
  sizes.emplace_back(2, 40);
  return sizes;
}

TEST(Rows, KeepBoxesApart) {
  const std::vector<Vec2> sizes = some_sizes();
  const std::vector<Vec2> corners = place_in_rows(sizes);
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const bool aside = corners[a].x() > corners[b].x() + sizes[b].x() ||
                         corners[b].x() > corners[a].x() + sizes[a].x();
      const bool above = corners[a].y() > corners[b].y() + sizes[b].y() ||
                         corners[b].y() > corners[a].y() + sizes[a].y();
      EXPECT_TRUE(aside || above) << a << " " << b;
    }
  }
}

TEST(Rows, FillASquareLessThanTwice) {
  const std::vector<Vec2> sizes = some_sizes();
  const std::vector<Vec2> corners = place_in_rows(sizes);
  double area = 0;
  Vec2 end = Vec2::Zero();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    area += sizes[i].prod();
    end = end.cwiseMax(corners[i] + sizes[i]);
  }
  EXPECT_LT(end.prod(), 2 * area);
  EXPECT_LT(end.x(), 1.1 * std::sqrt(area));
}

TEST(Rows, PutThinBoxesNearTheAxis) {
  std::vector<Vec2> sizes(10, Vec2(1, 1));
  for (int i = 0; i < 30; ++i) sizes.emplace_back(1, 1e-9);
  const std::vector<Vec2> corners = place_in_rows(sizes);
  for (std::size_t i = 10; i < sizes.size(); ++i) EXPECT_LT(corners[i].y(), 1e-7);
}

}  // namespace
}  // namespace beltrami
