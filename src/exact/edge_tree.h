// A binary tree of bounding boxes over the consecutive edges of a closed polygon.
#pragma once

#include <vector>

#include "base/interrupt.h"
#include "exact/polygon.h"

namespace beltrami {

/// Edges that are near in the loop are near in the plane, so the loop order is a good hierarchy as
/// it stands. Keeps the polygon's references.
class EdgeTree {
 public:
  explicit EdgeTree(const ClosedPolygon& polygon);

  Index leaf_count() const { return leaf_count_; }

  /// Takes over that the ends of an edge have moved.
  void update(Index edge);

  /// Calls visit(other) for the edges whose boxes meet that of `edge`, itself included, and
  /// look() for each box on the way, until one of them returns false; then returns false.
  template <class Look, class Visit>
  bool for_each_near(Index edge, const Look& look, const Visit& visit) {
    stack_.assign(1, 1);
    while (!stack_.empty()) {
      const Index node = stack_.back();
      stack_.pop_back();
      poll_();
      if (!look()) return false;
      if (!boxes_[node].intersects(boxes_[leaf_count_ + edge])) continue;
      if (node >= leaf_count_) {
        if (!visit(node - leaf_count_)) return false;
        continue;
      }
      stack_.push_back(2 * node + 1);
      stack_.push_back(2 * node);
    }
    return true;
  }

 private:
  void enclose(Index edge);

  const ClosedPolygon polygon_;
  Index leaf_count_;
  std::vector<Eigen::AlignedBox2d> boxes_;
  std::vector<Index> stack_;
  PollSometimes poll_;
};

}  // namespace beltrami
