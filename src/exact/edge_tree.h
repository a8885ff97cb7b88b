// A binary tree of bounding boxes over the consecutive edges of a closed polygon.
#pragma once

#include "base/types.h"
#include "exact/box_tree.h"
#include "exact/polygon.h"

namespace beltrami {

/// Edges that are near in the loop are near in the plane, so the loop order is a good hierarchy as
/// it stands. Keeps the polygon's references.
class EdgeTree {
 public:
  explicit EdgeTree(const ClosedPolygon& polygon);

  /// Takes over that the ends of an edge have moved.
  void update(Index edge);

  /// Calls visit(other) for the edges whose boxes meet that of `edge`, itself included, and
  /// look() for each box on the way, until one of them returns false; then returns false.
  template <class Look, class Visit>
  bool for_each_near(Index edge, const Look& look, const Visit& visit) {
    return tree_.for_each_near(tree_.box(edge), look, visit);
  }

  /// Calls visit(e, f) for the edges e < f whose boxes meet, and look() for each two boxes on the
  /// way, until one of them returns false; then returns false.
  template <class Look, class Visit>
  bool for_each_pair(const Look& look, const Visit& visit) {
    return tree_.for_each_pair(look, visit);
  }

 private:
  const ClosedPolygon polygon_;
  BoxTree tree_;
};

}  // namespace beltrami
