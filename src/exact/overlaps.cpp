#include "exact/overlaps.h"

#include <algorithm>
#include <functional>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/box_tree.h"
#include "exact/line_order.h"
#include "exact/orientation.h"

namespace beltrami {
namespace {

using Pair = std::array<Index, 2>;
constexpr std::int64_t kGrain = 8192;

/// The bits of x, each followed by a 0.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ffff0000ffff;
  x = (x | x << 8) & 0x00ff00ff00ff00ff;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0f;
  x = (x | x << 2) & 0x3333333333333333;
  return (x | x << 1) & 0x5555555555555555;
}

/// Faces with a sign along a Z-shaped curve, on which those that are near are mostly near.
std::vector<Index> along_curve(const SignedTriangles& triangles, const std::vector<Box2>& boxes,
                               const Work& work) {
  const std::vector<Index> faces = parallel_filter(
      work, size_of(triangles.faces), kGrain, [&](Index f) { return triangles.signs[f] != 0; });
  Box2 whole;
  for (const Index f : faces) whole.extend(boxes[f]);
  // Halves, as the difference of the greatest numbers is none.
  const Vec2 low = whole.min() / 2, size = whole.max() / 2 - low;
  struct Keyed {
    std::uint64_t key;
    Index face;
  };
  std::vector<Keyed> keyed(faces.size());
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      std::array<std::uint64_t, 2> cell;
      for (int axis = 0; axis < 2; ++axis) {
        const double along = (boxes[faces[i]].min()[axis] / 2 - low[axis]) / size[axis];
        cell[axis] = along > 0 ? static_cast<std::uint64_t>(along * 0xffffffffu) : 0;
      }
      keyed[i] = {spread(cell[0]) << 1 | spread(cell[1]), faces[i]};
    }
  });
  sort_interruptibly(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key < b.key || (a.key == b.key && a.face < b.face);
  });
  std::vector<Index> order;
  order.reserve(keyed.size());
  for (const Keyed& k : keyed) order.push_back(k.face);
  return order;
}

std::vector<Box2> boxes_of(const SignedTriangles& triangles, const Work& work) {
  std::vector<Box2> boxes(triangles.faces.size());
  parallel_for(work, size_of(boxes), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (const Index v : triangles.faces[f]) boxes[f].extend(triangles.uvs[v]);
    }
  });
  return boxes;
}

class Search {
 public:
  Search(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary, const Work& work)
      : triangles_(triangles),
        boxes_(boxes_of(triangles, work)),
        order_(along_curve(triangles, boxes_, work)),
        tree_(in_order()),
        bounds_(size_of(order_)),
        at_boundary_(triangles.faces.size(), 0) {
    for (const UvEdge& e : boundary) at_boundary_[e.face()] |= 1 << e.corner % 3;
  }

  Overlaps run(Index suspect, std::int64_t most, const Work& work) {
    // Without bounds, so that one pair at least is found.
    list(suspect, true, [] { return true; });
    const Index count = size_of(at_boundary_);
    bool complete = true;
    for (Index f = 0; f < count && complete; ++f) {
      if (f % kReportEvery == 0) work.report(static_cast<double>(f) / count);
      if (at_boundary_[f] != 0) complete = list(f, false, [&] { return bounds_.look(); });
    }
    Overlaps overlaps;
    overlaps.complete = complete;
    overlaps.faces = first_of(faces_, most, overlaps.first_faces);
    overlaps.edges = first_of(edges_, most, overlaps.first_edges);
    return overlaps;
  }

 private:
  static constexpr Index kReportEvery = 1 << 16;

  std::vector<Box2> in_order() const {
    std::vector<Box2> boxes;
    boxes.reserve(order_.size());
    for (const Index f : order_) boxes.push_back(boxes_[f]);
    return boxes;
  }

  /// Appends the pairs of a face, those with later ones that are at the boundary themselves only
  /// `with_later`. False if a bound was reached.
  template <class Look>
  bool list(Index face, bool with_later, const Look& look) {
    return tree_.for_each_near(boxes_[face], look, [&](Index item) {
      const Index other = order_[item];
      const bool in_turn = other > face && at_boundary_[other] != 0;
      if (other == face || (in_turn && !with_later) || !overlap(face, other)) return true;
      faces_.push_back({std::min(face, other), std::max(face, other)});
      list_edges(faces_.back()[0], faces_.back()[1]);
      return bounds_.pair();
    });
  }

  void list_edges(Index f, Index g) {
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        if ((at_boundary_[f] >> i & at_boundary_[g] >> j & 1) == 0) continue;
        if (cross(edge(f, i), edge(g, j))) edges_.push_back({3 * f + i, 3 * g + j});
      }
    }
  }

  /// An edge whose triangle is on its left.
  std::array<Vec2, 2> edge(Index f, Index k) const {
    const Triangle& face = triangles_.faces[f];
    const Vec2 &a = triangles_.uvs[face[k]], &b = triangles_.uvs[face[(k + 1) % 3]];
    return triangles_.signs[f] > 0 ? std::array{a, b} : std::array{b, a};
  }

  /// Whether two triangles have an open set in common: else the line of an edge separates them.
  bool overlap(Index f, Index g) const { return !separated(f, g) && !separated(g, f); }

  bool separated(Index f, Index g) const {
    for (Index k = 0; k < 3; ++k) {
      const std::array<Vec2, 2> e = edge(f, k);
      const Triangle& other = triangles_.faces[g];
      if (std::all_of(other.begin(), other.end(),
                      [&](Index v) { return orientation(e[0], e[1], triangles_.uvs[v]) <= 0; })) {
        return true;
      }
    }
    return false;
  }

  static bool cross(const std::array<Vec2, 2>& e, const std::array<Vec2, 2>& f) {
    const int e_f0 = orientation(e[0], e[1], f[0]), e_f1 = orientation(e[0], e[1], f[1]);
    if (e_f0 != 0 || e_f1 != 0) {
      return e_f0 * e_f1 < 0 && orientation(f[0], f[1], e[0]) * orientation(f[0], f[1], e[1]) < 0;
    }
    const Segment s = segment_between(e[0], e[1]), t = segment_between(f[0], f[1]);
    const bool one_direction = is_before(e[0], e[1]) == is_before(f[0], f[1]);
    return one_direction && is_before(s.left, t.right) && is_before(t.left, s.right);
  }

  /// The number of different pairs, and the first of them.
  static std::int64_t first_of(std::vector<Pair>& pairs, std::int64_t most,
                               std::vector<Pair>& first) {
    sort_interruptibly(pairs.begin(), pairs.end(), std::less<>());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    const auto count = static_cast<std::int64_t>(pairs.size());
    first.assign(pairs.begin(), pairs.begin() + std::min(count, most));
    return count;
  }

  const SignedTriangles& triangles_;
  const std::vector<Box2> boxes_;
  const std::vector<Index> order_;
  BoxTree tree_;
  ListingBounds bounds_;
  std::vector<std::uint8_t> at_boundary_;  // per face, a bit for each edge
  std::vector<Pair> faces_, edges_;
};

}  // namespace

Overlaps list_overlaps(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary,
                       Index suspect, std::int64_t most, const Work& work) {
  return Search(triangles, boundary, work).run(suspect, most, work);
}

}  // namespace beltrami
