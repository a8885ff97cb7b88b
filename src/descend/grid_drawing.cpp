#include "descend/grid_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/types.h"

namespace beltrami {
namespace {

/// A vertex as it is added to the drawing: on top of the contour, above its neighbours from `left`
/// to `right`.
struct Addition {
  Index vertex, left, right;
};

/// Takes vertices off the disk, one at a time, so that a disk remains: a canonical ordering from
/// its end. The bottom edge, from boundary[0] to boundary[1], stays.
class Peeling {
 public:
  explicit Peeling(const DiskMesh& mesh)
      : mesh_(mesh),
        next_(mesh.vertex_count(), kNone),
        previous_(next_),
        chords_(mesh.vertex_count(), 0),
        outside_(mesh.on_boundary),
        removed_(mesh.vertex_count(), false) {
    const Index count = size_of(mesh.boundary);
    for (Index i = 0; i < count; ++i) {
      link(mesh.boundary[i], mesh.boundary[i + 1 == count ? 0 : i + 1]);
    }
    for (Index h = 0; h < size_of(mesh.twin); ++h) {
      if (mesh.twin[h] == kNone) continue;
      if (outside_[mesh.origin(h)] && outside_[mesh.target(h)]) ++chords_[mesh.origin(h)];
    }
    for (const Index v : mesh.boundary) consider(v);
  }

  /// Every vertex but those of the bottom edge, in the order in which they can be added.
  std::vector<Addition> run() {
    std::vector<Addition> additions;
    const Index count = mesh_.vertex_count() - 2;
    additions.reserve(count);
    // The queue grows meanwhile. Some vertex without chords is always left (de Fraysseix et al.).
    for (std::size_t i = 0; size_of(additions) < count; ++i) {
      const Index v = candidates_[i];
      if (removed_[v] || chords_[v] > 0) continue;
      additions.push_back({v, next_[v], previous_[v]});
      remove(v);
    }
    std::reverse(additions.begin(), additions.end());
    return additions;
  }

 private:
  void link(Index from, Index to) {
    next_[from] = to;
    previous_[to] = from;
  }

  void consider(Index v) {
    const bool bottom = v == mesh_.boundary[0] || v == mesh_.boundary[1];
    if (!bottom && chords_[v] == 0) candidates_.push_back(v);
  }

  /// The inner neighbours of a vertex of the outer loop, from the one after it on the loop to the
  /// one before.
  std::vector<Index> inner_neighbours(Index v) const {
    Index h = kNone;
    mesh_.for_each_outgoing(v, [&](Index g) {
      if (mesh_.target(g) == next_[v]) h = g;
    });
    std::vector<Index> inner;
    for (;; h = mesh_.rotate(h)) {
      const Index u = mesh_.origin(DiskMesh::previous(h));
      if (u == previous_[v]) return inner;
      inner.push_back(u);
    }
  }

  void remove(Index v) {
    const std::vector<Index> inner = inner_neighbours(v);
    const Index after = next_[v], before = previous_[v];
    removed_[v] = true;
    Index last = after;
    for (const Index u : inner) {
      link(u, last);
      last = u;
    }
    link(before, last);
    if (inner.empty()) {  // the chord below it is now an edge of the loop
      for (const Index u : {before, after}) {
        --chords_[u];
        consider(u);
      }
      return;
    }
    for (const Index u : inner) {
      mesh_.for_each_outgoing(u, [&](Index h) {
        const Index x = mesh_.target(h);
        if (!outside_[x] || removed_[x] || x == next_[u] || x == previous_[u]) return;
        ++chords_[u];
        ++chords_[x];
      });
      outside_[u] = true;  // later ones count their chords with this one
    }
    for (const Index u : inner) consider(u);
  }

  const DiskMesh& mesh_;
  std::vector<Index> next_, previous_;  // on the outer loop, the surface on its left
  std::vector<Index> chords_;           // edges to vertices of the loop that are not beside it
  std::vector<bool> outside_, removed_;
  std::vector<Index> candidates_;
};

/// Abscissas relative to a parent in a binary tree, so that what a new vertex shifts need not be
/// visited.
struct Drawing {
  std::vector<std::int64_t> offset, height;
  std::vector<Index> left, right;  ///< children; on the contour `right` is the next one

  explicit Drawing(Index count)
      : offset(count, 0), height(offset), left(count, kNone), right(left) {}

  void add(const Addition& added) {
    const Index first = right[added.left];
    const Index v = added.vertex, q = added.right;
    ++offset[first];
    ++offset[q];
    std::int64_t width = 0;
    Index last = added.left;
    for (Index w = first;; w = right[w]) {
      width += offset[w];
      if (w == q) break;
      last = w;
    }
    offset[v] = (width + height[q] - height[added.left]) / 2;
    height[v] = (width + height[q] + height[added.left]) / 2;
    offset[q] = width - offset[v];
    right[added.left] = v;
    right[v] = q;
    if (first == q) return;
    offset[first] -= offset[v];
    left[v] = first;
    right[last] = kNone;
  }
};

}  // namespace

std::vector<Vec2> grid_drawing(const DiskMesh& mesh) {
  const std::vector<Addition> additions = Peeling(mesh).run();
  const Index a = mesh.boundary[0], b = mesh.boundary[1];
  Drawing drawing(mesh.vertex_count());
  drawing.right[a] = b;
  for (const Addition& added : additions) drawing.add(added);

  const auto count = static_cast<double>(mesh.vertex_count());
  const int below = std::ilogb(count);
  const int exponent = count < std::ldexp(std::numbers::sqrt2, below) ? -below : -below - 1;
  std::vector<Vec2> uvs(mesh.vertex_count());
  std::vector<std::pair<Index, std::int64_t>> open{{a, 0}};
  while (!open.empty()) {
    const auto [v, from] = open.back();
    open.pop_back();
    const std::int64_t x = from + drawing.offset[v];
    uvs[v] = {std::ldexp(static_cast<double>(x), exponent),
              std::ldexp(static_cast<double>(drawing.height[v]), exponent)};
    for (const Index child : {drawing.left[v], drawing.right[v]}) {
      if (child != kNone) open.emplace_back(child, x);
    }
  }
  return uvs;
}

}  // namespace beltrami
