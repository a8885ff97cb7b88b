#include "cut/seam_paths.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {

SeamPaths::SeamPaths(const Surface& surface, const std::vector<bool>& is_root,
                     const std::vector<double>& cost)
    : surface_(surface),
      cost_(surface.positions.size(), std::numeric_limits<double>::infinity()),
      towards_(surface.positions.size(), kNone) {
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (!is_root[v]) continue;
    cost_[v] = 0;
    queue.emplace(0, v);
  }
  PollSometimes poll;
  while (!queue.empty()) {
    poll();
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > cost_[v] || surface.outgoing[v] == kNone) continue;
    const auto relax = [&, reached = reached](Index h, Index other) {
      const double through = reached + cost[h];
      if (!(through < cost_[other])) return;
      cost_[other] = through;
      towards_[other] = h;
      queue.emplace(through, other);
    };
    surface.for_each_outgoing(v, [&](Index h) {
      relax(h, surface.target(h));
      if (surface.rotate(h) == kNone)
        relax(Surface::previous(h), surface.origin(Surface::previous(h)));
    });
  }
}

SeamPath SeamPaths::from(Index vertex) const {
  SeamPath path;
  path.cost = cost_[vertex];
  while (towards_[vertex] != kNone) {
    const Index h = towards_[vertex];
    path.halfedges.push_back(h);
    path.vertices.push_back(vertex);
    vertex = surface_.origin(h) == vertex ? surface_.target(h) : surface_.origin(h);
  }
  return path;
}

}  // namespace beltrami
