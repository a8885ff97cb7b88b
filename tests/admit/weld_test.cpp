// Which vertices become one.
#include "admit/weld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

TEST(Weld, EqualPositionsBecomeTheFirstOfThem) {
  const std::vector<Vec3> positions = {{1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {-0.0, 0, -0.0}, {1, 3, 2}};
  EXPECT_EQ(weld(positions, 0, Work(1)), (std::vector<Index>{0, 1, 0, 1, 4}));
}

TEST(Weld, TheLeastDistanceIsNone) {
  const double least = std::numeric_limits<double>::denorm_min();
  const std::vector<Vec3> positions = {{0, 0, 0}, {1e-310, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(weld(positions, least, Work(1)), (std::vector<Index>{0, 1, 0}));
  EXPECT_EQ(weld({{0, 0, 0}, {0, 0, 0}}, least, Work(1)), (std::vector<Index>{0, 0}));
}

TEST(Weld, ADistanceHoldsAlongChains) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 10; ++i) positions.emplace_back(0.9 * i, 0, 0);
  positions.emplace_back(0.9 * 9 + 1.1, 0, 0);
  const std::vector<Index> first = weld(positions, 1, Work(1));
  EXPECT_EQ(std::count(first.begin(), first.end(), 0), 10);
  EXPECT_EQ(first[10], 10);
}

TEST(Weld, IsWhatAllPairsSay) {
  const std::vector<Vec3> positions = meshes::random_soup(400, 1, 7).positions;
  for (const double distance : {2e4, 7e4, 1.5e5}) {
    DisjointSets sets(size_of(positions));
    for (Index i = 0; i < size_of(positions); ++i) sets.make(i);
    for (Index i = 0; i < size_of(positions); ++i) {
      for (Index j = 0; j < i; ++j) {
        if ((positions[i] - positions[j]).norm() <= distance) sets.unite(i, j);
      }
    }
    EXPECT_EQ(weld(positions, distance, Work(2)), std::move(sets).roots()) << distance;
  }
}

TEST(Weld, ADistanceBelowTheResolutionIsNone) {
  const std::vector<Vec3> positions = {{1e300, 0, 0}, {0, 0, 0}, {1e-300, 0, 0}};
  EXPECT_EQ(weld(positions, 1e-200, Work(1)), (std::vector<Index>{0, 1, 2}));
}

}  // namespace
}  // namespace beltrami
