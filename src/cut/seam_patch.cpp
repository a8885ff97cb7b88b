#include "cut/seam_patch.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace beltrami {

void SeamPatch::clear() {
  for (const Index v : vertices_) number_[v] = kNone;
  vertices_.clear();
  euler_ = 0;
}

void SeamPatch::add(Index v, Index change) {
  euler_ += change;
  number_[v] = size();
  vertices_.push_back(v);
}

void SeamPatch::try_add(Index v) {
  const Index change = euler_with(v);
  if (change == 0 || (change == 1 && euler_ < 1)) add(v, change);
}

/// By how much the vertex, its edges into the patch and faces between these raise the Euler
/// characteristic: 1 less the runs of neighbours, or 1 where they go all around.
Index SeamPatch::euler_with(Index v) const {
  Index edges = 0, faces = 0, last = kNone;
  surface_.for_each_outgoing(v, [&](Index h) {
    const bool has_this = number_[surface_.target(h)] != kNone;
    last = surface_.origin(Surface::previous(h));
    edges += has_this ? 1 : 0;
    faces += has_this && number_[last] != kNone ? 1 : 0;
  });
  if (surface_.on_boundary[v] && number_[last] != kNone) ++edges;
  return 1 - edges + faces;
}

void SeamPatch::grow(Index rings, const std::vector<Index>& degree) {
  Index next = 0;
  for (Index ring = 0; ring < rings; ++ring) {
    for (const Index end = size(); next < end; ++next) {
      poll_();
      surface_.for_each_outgoing(vertex(next), [&](Index h) {
        const Index v = surface_.target(h);
        if (number_[v] == kNone && degree[v] == 0 && !surface_.on_boundary[v]) try_add(v);
      });
    }
  }
}

void SeamPatch::find_paths(const PathQuery& query, const std::vector<double>& cost,
                           const EdgeMarks& locked, const EdgeMarks& seams, PathTree& tree) {
  tree.distance.assign(size(), std::numeric_limits<double>::infinity());
  tree.reached_by.assign(size(), kNone);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  tree.distance[number(query.start)] = 0;
  queue.emplace(0, number(query.start));
  while (!queue.empty()) {
    poll_();
    const auto [reached, n] = queue.top();
    queue.pop();
    if (reached > tree.distance[n]) continue;
    const Index v = vertex(n);
    if (v == query.goal) return;
    if (v == query.through_none[0] || v == query.through_none[1]) continue;
    surface_.for_each_outgoing(v, [&, reached = reached](Index h) {
      const Index other = number(surface_.target(h));
      if (other == kNone || surface_.twin[h] == kNone) return;
      const double through = reached + cost[h];
      if (!(through < query.below) || !(through < tree.distance[other])) return;
      if (!locked.empty() && locked[h] && !seams[h]) return;
      if (v == query.start && surface_.target(h) == query.not_between) return;
      tree.distance[other] = through;
      tree.reached_by[other] = h;
      queue.emplace(through, other);
    });
  }
}

}  // namespace beltrami
