#include "exact/certificate.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/parallel.h"

namespace beltrami {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = Eigen::AlignedBox2d;

constexpr std::int64_t kGrain = 8192;

int face_orientation(const Triangle& face, const std::vector<Vec2>& uvs) {
  return orientation(uvs[face[0]], uvs[face[1]], uvs[face[2]]);
}

/// A binary tree of bounding boxes over the consecutive edges of a closed polygon. Edges that are
/// near in the loop are near in the plane, so the loop order is a good hierarchy as it stands.
class PolygonCrossings {
 public:
  PolygonCrossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs)
      : loop_(loop), uvs_(uvs), edge_count_(size_of(loop)) {
    while (leaf_count_ < edge_count_) leaf_count_ *= 2;
    boxes_.resize(2 * static_cast<std::size_t>(leaf_count_));
    for (Index e = 0; e < edge_count_; ++e) {
      boxes_[leaf_count_ + e].extend(start(e));
      boxes_[leaf_count_ + e].extend(end(e));
    }
    for (Index node = leaf_count_ - 1; node > 0; --node) {
      boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
    }
  }

  std::vector<std::array<Index, 2>> find() {
    visit_within(1);
    return std::move(found_);
  }

 private:
  Index vertex_after(Index e) const { return loop_[e + 1 == edge_count_ ? 0 : e + 1]; }
  const Vec2& start(Index e) const { return uvs_[loop_[e]]; }
  const Vec2& end(Index e) const { return uvs_[vertex_after(e)]; }

  void visit_within(Index node) {
    if (node >= leaf_count_ || boxes_[node].isEmpty()) return;
    visit_within(2 * node);
    visit_within(2 * node + 1);
    visit_between(2 * node, 2 * node + 1);
  }

  void visit_between(Index a, Index b) {
    if (!boxes_[a].intersects(boxes_[b])) return;
    if (a >= leaf_count_) {  // both are: the tree is complete and a, b are on one level
      test_edges(a - leaf_count_, b - leaf_count_);
      return;
    }
    for (const Index i : {2 * a, 2 * a + 1}) {
      for (const Index j : {2 * b, 2 * b + 1}) visit_between(i, j);
    }
  }

  void test_edges(Index e, Index f) {
    const bool f_follows = vertex_after(e) == loop_[f];
    const bool e_follows = vertex_after(f) == loop_[e];
    bool illegal = false;
    if (f_follows) illegal = folds_back(start(e), end(e), end(f));
    if (e_follows) illegal = illegal || folds_back(start(f), end(f), end(e));
    if (!f_follows && !e_follows) illegal = segments_meet(e, f);
    if (illegal) found_.push_back({e, f});
  }

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

  bool segments_meet(Index e, Index f) const {
    // The boxes touch (the caller saw to it), which settles the collinear case too: collinear
    // segments with touching boxes share a point.
    return orientation(start(e), end(e), start(f)) * orientation(start(e), end(e), end(f)) <= 0 &&
           orientation(start(f), end(f), start(e)) * orientation(start(f), end(f), end(e)) <= 0;
  }

  const std::vector<Index>& loop_;
  const std::vector<Vec2>& uvs_;
  Index edge_count_;
  Index leaf_count_ = 1;
  std::vector<Box> boxes_;
  std::vector<std::array<Index, 2>> found_;
};

}  // namespace

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return static_cast<int>(CGAL::orientation(
      Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()), Kernel::Point_2(c.x(), c.y())));
}

std::vector<Index> non_positive_faces(const std::vector<Triangle>& faces,
                                      const std::vector<Vec2>& uvs, int threads) {
  return parallel_filter(threads, size_of(faces), kGrain,
                         [&](Index f) { return face_orientation(faces[f], uvs) <= 0; });
}

Orientations count_orientations(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                                int threads) {
  const std::vector<Index> bad = non_positive_faces(faces, uvs, threads);
  Orientations counts;
  counts.positive = size_of(faces) - size_of(bad);
  for (const Index f : bad) {
    ++(face_orientation(faces[f], uvs) < 0 ? counts.negative : counts.degenerate);
  }
  if (!bad.empty()) counts.first_bad_face = bad.front();
  return counts;
}

std::vector<std::array<Index, 2>> find_crossings(const std::vector<Index>& loop,
                                                 const std::vector<Vec2>& uvs) {
  return PolygonCrossings(loop, uvs).find();
}

Crossings count_crossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs) {
  const auto pairs = find_crossings(loop, uvs);
  Crossings crossings{static_cast<std::int64_t>(pairs.size()), {kNone, kNone}};
  if (!pairs.empty()) crossings.first_pair = {loop[pairs[0][0]], loop[pairs[0][1]]};
  return crossings;
}

Certificate certify(const std::vector<Triangle>& faces, const std::vector<Index>& loop,
                    const std::vector<Vec2>& uvs, int threads) {
  return {count_orientations(faces, uvs, threads), count_crossings(loop, uvs)};
}

}  // namespace beltrami
