#include "pack/clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/vectors.h"

namespace beltrami {
namespace {

PlacedOutline square(double x, double y, double side) {
  return {0,
          {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}},
          {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
}

TEST(Clearance, IsTheDistanceOfTheBorders) {
  const Clearance least = clearance({square(10, 10, 5), square(18, 19, 5)}, 100, 20);
  EXPECT_DOUBLE_EQ(least.charts, 5);  // 3 and 4
  EXPECT_DOUBLE_EQ(least.page, 10);
}

TEST(Clearance, IsNoneAcrossPages) {
  PlacedOutline other = square(12, 12, 5);
  other.page = 1;
  EXPECT_EQ(clearance({square(10, 10, 5), other}, 100, 3).charts, 3);
}

TEST(Clearance, IsNoneBetweenThoseThatStay) {
  PlacedOutline one = square(10, 10, 5), other = square(12, 12, 5), beyond = square(-3, 50, 5);
  one.stays = other.stays = beyond.stays = true;
  EXPECT_EQ(clearance({one, other, beyond}, 100, 3).charts, 3);
  EXPECT_EQ(clearance({one, other, beyond}, 100, 3).page, 3);
  EXPECT_EQ(clearance({one, other, square(18, 12, 5)}, 100, 3).charts, 1);
}

TEST(Clearance, IsZeroWhereChartsCrossFarFromTheirVertices) {
  PlacedOutline bar = square(10, 10, 0);
  bar.points = {{10, 48}, {90, 48}, {90, 52}, {10, 52}};
  PlacedOutline upright = bar;
  for (Vec2& p : upright.points) std::swap(p.x(), p.y());
  EXPECT_EQ(clearance({bar, upright}, 100, 1).charts, 0);
}

TEST(Clearance, IsZeroWhereOneLiesOnTheOther) {
  EXPECT_EQ(clearance({square(10, 10, 80), square(40, 40, 5)}, 100, 1).charts, 0);
  EXPECT_EQ(clearance({square(40, 40, 5), square(10, 10, 80)}, 100, 1).charts, 0);
}

TEST(Clearance, IsNegativeOutsideOfThePage) {
  EXPECT_DOUBLE_EQ(clearance({square(-3, 10, 5)}, 100, 1).page, -3);
  EXPECT_DOUBLE_EQ(clearance({square(98, 10, 5)}, 100, 1).page, -3);
}

}  // namespace
}  // namespace beltrami
