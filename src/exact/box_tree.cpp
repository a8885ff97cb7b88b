#include "exact/box_tree.h"

#include <algorithm>
#include <bit>

namespace beltrami {
namespace {

/// Bounds of a listing: pairs, and boxes looked at per item and level of the tree.
constexpr std::int64_t kPairsPerItem = 4, kFewPairs = 65536;
constexpr std::int64_t kBoxesPerItem = 8, kFewBoxes = 1 << 20;

std::uint32_t leaves_for(Index items) {
  return std::bit_ceil(static_cast<std::uint32_t>(items));
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box2>& boxes)
    : item_count_(size_of(boxes)), leaf_count_(static_cast<Index>(leaves_for(item_count_))) {
  boxes_.resize(2 * static_cast<std::size_t>(leaf_count_));
  std::copy(boxes.begin(), boxes.end(), boxes_.begin() + leaf_count_);
  for (Index node = leaf_count_ - 1; node > 0; --node) {
    boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
  }
}

void BoxTree::update(Index item, const Box2& box) {
  boxes_[leaf_count_ + item] = box;
  for (Index node = (leaf_count_ + item) / 2; node > 0; node /= 2) {
    boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
  }
}

ListingBounds::ListingBounds(Index items) {
  const std::int64_t levels = std::bit_width(leaves_for(items));
  boxes_left_ = std::max(kFewBoxes, kBoxesPerItem * levels * items);
  pairs_left_ = std::max(kFewPairs, kPairsPerItem * items);
}

}  // namespace beltrami
