// The tree of boxes: what meets, and nothing that is not there.
#include "exact/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "base/vectors.h"

namespace beltrami {
namespace {

TEST(BoxTree, NamesItemsAlone) {
  // Three items: the fourth leaf is empty, its box the inverted one of all numbers.
  const double most = std::numeric_limits<double>::max();
  const std::vector<Box2> boxes(3, Box2(Vec2(-most, -most), Vec2(most, most)));
  BoxTree tree(boxes);
  const auto look = [] { return true; };
  std::vector<Index> near;
  EXPECT_TRUE(tree.for_each_near(boxes[0], look, [&](Index item) {
    near.push_back(item);
    return true;
  }));
  std::sort(near.begin(), near.end());
  EXPECT_EQ(near, (std::vector<Index>{0, 1, 2}));
  std::vector<std::array<Index, 2>> pairs;
  EXPECT_TRUE(tree.for_each_pair(look, [&](Index a, Index b) {
    pairs.push_back({a, b});
    return true;
  }));
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(pairs, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {1, 2}}));
}

}  // namespace
}  // namespace beltrami
