#include "cut/seam_paths.h"

#include <limits>

#include "base/interrupt.h"

namespace beltrami {

SeamPaths::SeamPaths(const Surface& surface, const std::vector<bool>& is_root,
                     const std::vector<double>& cost, double bound, const std::vector<bool>* goal)
    : surface_(surface),
      cost_of_edge_(cost),
      bound_(bound),
      costs_(surface.positions.size(), std::numeric_limits<double>::infinity()),
      towards_(surface.positions.size(), kNone) {
  Queue queue;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (!is_root[v]) continue;
    costs_[v] = 0;
    queue.emplace(0, v);
  }
  grow(queue, goal);
}

void SeamPaths::add_roots(std::span<const Index> vertices) {
  Queue queue;
  for (const Index v : vertices) {
    costs_[v] = 0;
    towards_[v] = kNone;
    queue.emplace(0, v);
  }
  grow(queue, nullptr);
}

void SeamPaths::grow(Queue& queue, const std::vector<bool>* goal) {
  PollSometimes poll;
  while (!queue.empty()) {
    poll();
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > costs_[v] || surface_.outgoing[v] == kNone) continue;
    if (goal != nullptr && (*goal)[v]) {
      reached_ = v;
      return;
    }
    const auto relax = [&, reached = reached](Index h, Index other) {
      const double through = reached + cost_of_edge_[h];
      if (!(through < costs_[other]) || through > bound_) return;
      costs_[other] = through;
      towards_[other] = h;
      queue.emplace(through, other);
    };
    surface_.for_each_outgoing(v, [&](Index h) {
      relax(h, surface_.target(h));
      const Index in = Surface::previous(h);
      if (surface_.rotate(h) == kNone) relax(in, surface_.origin(in));
    });
  }
}

SeamPath SeamPaths::from(Index vertex) const {
  SeamPath path;
  path.cost = costs_[vertex];
  while (towards_[vertex] != kNone) {
    const Index h = towards_[vertex];
    path.halfedges.push_back(h);
    path.vertices.push_back(vertex);
    vertex = surface_.origin(h) == vertex ? surface_.target(h) : surface_.origin(h);
  }
  return path;
}

}  // namespace beltrami
