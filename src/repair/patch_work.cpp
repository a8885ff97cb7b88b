#include "repair/patch_work.h"

#include <algorithm>

#include "base/types.h"
#include "exact/polygon.h"

namespace beltrami {

bool PatchWork::take(Patch& patch) {
  if (!patch.moves_boundary) {
    patch.exchange(uvs_);
    return true;
  }
  if (!tree_) {
    tree_.emplace(ClosedPolygon(mesh_.boundary, uvs_));
    position_.assign(mesh_.positions.size(), kNone);
    for (Index i = 0; i < size_of(mesh_.boundary); ++i) position_[mesh_.boundary[i]] = i;
  }
  const std::vector<Index> edges = moving_edges(patch);
  const std::int64_t before = crossings_of(edges);
  exchange(patch, edges);
  if (crossings_of(edges) <= before) return true;
  exchange(patch, edges);
  return false;
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
