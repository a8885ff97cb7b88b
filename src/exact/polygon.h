// A closed polygon as edges, and the exact test of two of them.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "exact/orientation.h"

namespace beltrami {

/// The polygon through uvs[loop[0]], uvs[loop[1]], ...: edge i runs from loop[i] to loop[i + 1].
/// Keeps references. Precondition: at least three vertices, each once in the loop, finite.
class ClosedPolygon {
 public:
  ClosedPolygon(const std::vector<Index>& loop, const std::vector<Vec2>& uvs)
      : loop_(loop), uvs_(uvs) {}

  Index edge_count() const { return size_of(loop_); }
  Index next(Index e) const { return e + 1 == edge_count() ? 0 : e + 1; }
  Index previous(Index e) const { return e == 0 ? edge_count() - 1 : e - 1; }
  const Vec2& start(Index e) const { return uvs_[loop_[e]]; }
  const Vec2& end(Index e) const { return start(next(e)); }
  bool neighbours(Index e, Index f) const { return next(e) == f || next(f) == e; }

  /// Whether two different edges share any point other than the end that neighbours have in common.
  bool meet(Index e, Index f) const {
    if (next(e) == f) return folds_back(start(e), end(e), end(f));
    if (next(f) == e) return folds_back(start(f), end(f), end(e));
    return segments_meet(e, f);
  }

  /// Whether edge e and the one after it overlap in more than the end that they share.
  bool folds_back_after(Index e) const { return folds_back(start(e), end(e), end(next(e))); }

 private:
  /// Whether the edges a-b and b-c, which share b, overlap in more than b.
  static bool folds_back(const Vec2& a, const Vec2& b, const Vec2& c) {
    if (orientation(a, b, c) != 0) return false;
    // Collinear: b must lie strictly between a and c. Comparing coordinates is exact.
    const auto between = [](double p, double q, double r) {
      return (p < q && q < r) || (p > q && q > r);
    };
    const bool x_straight = between(a.x(), b.x(), c.x()) || (a.x() == b.x() && b.x() == c.x());
    const bool y_straight = between(a.y(), b.y(), c.y()) || (a.y() == b.y() && b.y() == c.y());
    return !(x_straight && y_straight) || a == b || b == c;
  }

  bool boxes_meet(Index e, Index f) const {
    const Vec2 &a = start(e), &b = end(e), &c = start(f), &d = end(f);
    return (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
           (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
  }

  bool segments_meet(Index e, Index f) const {
    // Touching boxes settle the collinear case: collinear segments with touching boxes share a
    // point.
    return boxes_meet(e, f) &&
           orientation(start(e), end(e), start(f)) * orientation(start(e), end(e), end(f)) <= 0 &&
           orientation(start(f), end(f), start(e)) * orientation(start(f), end(f), end(e)) <= 0;
  }

  const std::vector<Index>& loop_;
  const std::vector<Vec2>& uvs_;
};

}  // namespace beltrami
