#include "cut/join_loops.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "mesh/split_fans.h"

namespace beltrami {
namespace {

/// The way from a vertex to the nearest loop of its piece.
struct Ways {
  std::vector<double> distance;  ///< per vertex
  std::vector<Index> loop;
  std::vector<Index> edge;  ///< the half-edge of its first edge, or kNone on loops
};

/// Calls visit(half-edge, other end) for each edge at the vertex.
template <class Visit>
void for_each_edge_at(const Surface& surface, Index v, const Visit& visit) {
  surface.for_each_outgoing(v, [&](Index h) {
    visit(h, surface.target(h));
    const Index last = Surface::previous(h);
    if (surface.twin[last] == kNone) visit(last, surface.origin(last));
  });
}

/// Shortest paths (Dijkstra 1959) from the loops of components with several.
Ways ways_to_loops(const Surface& surface, const Topology& topology,
                   const std::vector<double>& cost) {
  Ways ways;
  ways.distance.assign(surface.positions.size(), std::numeric_limits<double>::infinity());
  ways.loop.assign(surface.positions.size(), kNone);
  ways.edge.assign(surface.positions.size(), kNone);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const BoundaryLoops& loops = topology.loops;
  for (Index loop = 0; loop < loops.count(); ++loop) {
    if (topology.components[topology.component_of_loop[loop]].loops < 2) continue;
    for (Index i = loops.start[loop]; i < loops.start[loop + 1]; ++i) {
      const Index v = surface.origin(loops.halfedge[i]);
      ways.distance[v] = 0;
      ways.loop[v] = loop;
      queue.emplace(0, v);
    }
  }
  PollSometimes poll;
  while (!queue.empty()) {
    poll();
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > ways.distance[v]) continue;
    for_each_edge_at(surface, v, [&, reached = reached, v = v](Index h, Index other) {
      poll();
      const double through = reached + cost[h];
      if (!(through < ways.distance[other])) return;
      ways.distance[other] = through;
      ways.loop[other] = ways.loop[v];
      ways.edge[other] = h;
      queue.emplace(through, other);
    });
  }
  return ways;
}

/// Whether the marked edges and the boundary hang together: then all pieces are disks.
bool is_joined(const Surface& disk, const EdgeMarks& marks) {
  DisjointSets sets(disk.vertex_count());
  PollSometimes poll;
  Index boundary = kNone;
  for (Index v = 0; v < disk.vertex_count(); ++v) {
    poll();
    sets.make(v);
    if (!disk.on_boundary[v]) continue;
    if (boundary == kNone) boundary = v;
    sets.unite(boundary, v);
  }
  for (Index h = 0; h < size_of(disk.twin); ++h) {
    if (marks[h]) sets.unite(disk.origin(h), disk.target(h));
  }
  for (Index h = 0; h < size_of(disk.twin); ++h) {
    if (marks[h] && sets.root(disk.origin(h)) != sets.root(boundary)) return false;
  }
  return true;
}

}  // namespace

bool join_loops(const Surface& disk, const std::vector<double>& cost, EdgeMarks& marks,
                const Work& work) {
  if (is_joined(disk, marks)) return true;
  std::vector<Index> twin = disk.twin;
  for (std::size_t h = 0; h < twin.size(); ++h) {
    if (marks[h]) twin[h] = kNone;
  }
  const Surface surface = split_fans(disk.positions, disk.faces, twin, work).surface;
  const Topology topology = topology_of(surface, work);
  Index joints = 0;
  for (const Component& component : topology.components) joints += component.loops - 1;
  if (joints == 0) return true;

  const Ways ways = ways_to_loops(surface, topology, cost);
  struct Bridge {
    double length;
    Index h;
  };
  std::vector<Bridge> bridges;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (surface.twin[h] < h) continue;
    const Index a = surface.origin(h), b = surface.target(h);
    if (ways.loop[a] == ways.loop[b]) continue;
    const double length = ways.distance[a] + cost[h] + ways.distance[b];
    if (length < std::numeric_limits<double>::infinity()) bridges.push_back({length, h});
  }
  sort_interruptibly(bridges.begin(), bridges.end(), [](const Bridge& a, const Bridge& b) {
    return a.length != b.length ? a.length < b.length : a.h < b.h;
  });
  DisjointSets sets(topology.loops.count());
  for (Index loop = 0; loop < topology.loops.count(); ++loop) sets.make(loop);
  for (const Bridge& bridge : bridges) {
    Index a = surface.origin(bridge.h), b = surface.target(bridge.h);
    if (!sets.unite(ways.loop[a], ways.loop[b])) continue;
    --joints;
    mark_edge(disk, bridge.h, marks);
    for (Index v : {a, b}) {
      while (ways.edge[v] != kNone) {
        const Index h = ways.edge[v];
        mark_edge(disk, h, marks);
        v = surface.origin(h) == v ? surface.target(h) : surface.origin(h);
      }
    }
  }
  return joints == 0;
}

}  // namespace beltrami
