// The order of segments along a line that sweeps over the plane from left to right.
#pragma once

#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "exact/orientation.h"

namespace beltrami {

/// The order in which the line reaches points: from left to right, and on a vertical upwards, as if
/// it leaned a little. No segment is then parallel to it.
inline bool is_before(const Vec2& a, const Vec2& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

/// As the line meets it: `left` is before `right`.
struct Segment {
  Vec2 left, right;
};

inline Segment segment_between(const Vec2& a, const Vec2& b) {
  return is_before(a, b) ? Segment{a, b} : Segment{b, a};
}

/// Compares segments that the line meets at once, from below upwards; also with a point. Keeps a
/// reference. Segments that lie on one line come in the order of their numbers; a point that lies
/// on a segment is neither above nor below it. Precondition: no two cross where they are compared.
class LineOrder {
 public:
  using is_transparent = void;
  explicit LineOrder(const std::vector<Segment>& segments) : segments_(&segments) {}

  bool operator()(Index e, Index f) const { return is_below(e, f); }
  bool operator()(Index e, const Vec2& p) const { return side(e, p) > 0; }
  bool operator()(const Vec2& p, Index e) const { return side(e, p) < 0; }

  /// 1 if the point is above the segment, -1 below it, 0 on its line.
  int side(Index e, const Vec2& p) const {
    poll_();
    return orientation((*segments_)[e].left, (*segments_)[e].right, p);
  }

 private:
  bool is_below(Index e, Index f) const {
    if (e == f) return false;
    const bool f_later = is_before((*segments_)[e].left, (*segments_)[f].left);
    const Index earlier = f_later ? e : f, later = f_later ? f : e;
    int above = side(earlier, (*segments_)[later].left);  // of the later one
    if (above == 0) above = side(earlier, (*segments_)[later].right);
    if (above == 0) return e < f;
    return f_later == (above > 0);
  }

  const std::vector<Segment>* segments_;
  mutable PollSometimes poll_;
};

}  // namespace beltrami
