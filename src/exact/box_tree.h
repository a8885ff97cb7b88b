// A binary tree of bounding boxes over items in a given order.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"

namespace beltrami {

using Box2 = Eigen::AlignedBox2d;

/// A good hierarchy where items that are near in their order are near in the plane.
class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box2>& boxes);

  const Box2& box(Index item) const { return boxes_[leaf_count_ + item]; }

  /// Gives an item another box.
  void update(Index item, const Box2& box);

  /// Calls visit(item) for the items whose boxes meet `box`, and look() for each box on the way,
  /// until one of them returns false; then returns false.
  template <class Look, class Visit>
  bool for_each_near(const Box2& box, const Look& look, const Visit& visit) {
    stack_.assign(1, 1);
    while (!stack_.empty()) {
      const Index node = pop();
      poll_();
      if (!look()) return false;
      if (!boxes_[node].intersects(box)) continue;
      if (node >= leaf_count_) {
        if (is_item(node) && !visit(node - leaf_count_)) return false;
        continue;
      }
      stack_.push_back(2 * node + 1);
      stack_.push_back(2 * node);
    }
    return true;
  }

  /// Calls visit(a, b) for the items a < b whose boxes meet, and look() for each two boxes on the
  /// way, until one of them returns false; then returns false.
  template <class Look, class Visit>
  bool for_each_pair(const Look& look, const Visit& visit) {
    stack_.assign({1, 1});
    while (!stack_.empty()) {
      const Index b = pop(), a = pop();
      poll_();
      if (!look()) return false;
      if (a != b && !boxes_[a].intersects(boxes_[b])) continue;
      if (a >= leaf_count_) {
        if (a == b || !is_item(a) || !is_item(b)) continue;
        if (!visit(a - leaf_count_, b - leaf_count_)) return false;
        continue;
      }
      const auto push = [&](Index first, Index second) {
        stack_.push_back(first);
        stack_.push_back(second);
      };
      push(2 * a + 1, 2 * b + 1);
      push(2 * a, 2 * b + 1);
      if (a != b) push(2 * a + 1, 2 * b);
      push(2 * a, 2 * b);
    }
    return true;
  }

 private:
  Index pop() {
    const Index node = stack_.back();
    stack_.pop_back();
    return node;
  }

  /// Empty boxes fill the tree up, and meet those that reach to the ends of the numbers.
  bool is_item(Index node) const { return node - leaf_count_ < item_count_; }

  Index item_count_, leaf_count_;
  std::vector<Box2> boxes_;
  std::vector<Index> stack_;
  PollSometimes poll_;
};

/// What a listing of pairs may cost, so that it takes O(n log n) whatever the items.
class ListingBounds {
 public:
  explicit ListingBounds(Index items);

  /// Whether another box may be looked at.
  bool look() { return --boxes_left_ >= 0; }
  /// Whether there is room after another pair.
  bool pair() { return --pairs_left_ >= 0; }

 private:
  std::int64_t boxes_left_, pairs_left_;
};

}  // namespace beltrami
