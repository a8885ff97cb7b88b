#include "local/patch_work.h"

#include <algorithm>

#include "base/types.h"
#include "exact/polygon.h"

namespace beltrami {

bool PatchWork::take(Patch& patch) {
  if (!patch.moves_boundary) {
    patch.exchange(uvs_);
    return true;
  }
  follow_boundary();
  const std::vector<Index> edges = moving_edges(patch);
  const std::int64_t before = crossings_of(edges);
  exchange(patch, edges);
  if (crossings_of(edges) <= before) return true;
  exchange(patch, edges);
  return false;
}

void PatchWork::straighten_boundary(Patch& patch) {
  if (!patch.moves_boundary) return;
  follow_boundary();
  const ClosedPolygon polygon(mesh_.boundary, uvs_);
  const std::vector<Index>& all = patch.mesh_vertices;
  // What is beside a vertex that may move is in the patch, too.
  const auto local = [&](Index at) {
    return std::lower_bound(all.begin(), all.end(), mesh_.boundary[at]) - all.begin();
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (patch.fixed[i] || !mesh_.on_boundary[all[i]]) continue;
    const Index before = polygon.previous(position_[all[i]]);
    if (!patch.fixed[local(before)]) continue;
    std::vector<std::ptrdiff_t> part;
    Index after = position_[all[i]];
    for (; !patch.fixed[local(after)]; after = polygon.next(after)) part.push_back(local(after));
    if (before == after) continue;  // no line
    const Vec2& start = polygon.start(before);
    const Vec2 way = polygon.start(after) - start;
    const double steps = static_cast<double>(part.size() + 1);
    for (std::size_t k = 0; k < part.size(); ++k) {
      patch.uvs[part[k]] = start + (static_cast<double>(k + 1) / steps) * way;
    }
  }
}

void PatchWork::follow_boundary() {
  if (tree_) return;
  tree_.emplace(ClosedPolygon(mesh_.boundary, uvs_));
  position_.assign(mesh_.positions.size(), kNone);
  for (Index i = 0; i < size_of(mesh_.boundary); ++i) position_[mesh_.boundary[i]] = i;
}

/// Positions in the boundary, increasing.
std::vector<Index> PatchWork::moving_edges(const Patch& patch) const {
  const ClosedPolygon polygon(mesh_.boundary, uvs_);
  std::vector<Index> edges;
  for (std::size_t i = 0; i < patch.mesh_vertices.size(); ++i) {
    const Index at = position_[patch.mesh_vertices[i]];
    if (at == kNone || patch.fixed[i]) continue;
    edges.push_back(at);
    edges.push_back(polygon.previous(at));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Pairs with one of the edges at least.
std::int64_t PatchWork::crossings_of(const std::vector<Index>& edges) {
  const ClosedPolygon polygon(mesh_.boundary, uvs_);
  std::int64_t count = 0;
  for (const Index edge : edges) {
    tree_->for_each_near(
        edge, [] { return true; },
        [&](Index other) {
          const bool again = other <= edge && std::binary_search(edges.begin(), edges.end(), other);
          count += !again && polygon.meet(edge, other);
          return true;
        });
  }
  return count;
}

void PatchWork::exchange(Patch& patch, const std::vector<Index>& edges) {
  patch.exchange(uvs_);
  for (const Index edge : edges) tree_->update(edge);
}

}  // namespace beltrami
