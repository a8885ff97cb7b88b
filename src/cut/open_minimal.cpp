#include "cut/open_minimal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/grouping.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "mesh/split_fans.h"

namespace beltrami {
namespace {

/// Roots on the best cut so far make shorter ones at once; more than six gain little. Components of
/// more than kRootFaces / kMostRoots faces try fewer.
constexpr int kLeastRoots = 3, kMostRoots = 6;
constexpr Index kRootFaces = 4'000'000;

/// The graph of a surface on which cuts are sought, and room for the search; components use parts
/// of their own. A joined loop is one node, its first vertex; every other vertex is one.
struct Graph {
  const Surface& surface;
  const BoundaryLoops& loops;
  const EdgeMarks& locked;            ///< or none
  std::vector<Index> loop_of_vertex;  ///< or kNone
  std::vector<Index> node;            ///< per vertex

  // Per node: the shortest-path tree, and the cut.
  std::vector<double> distance;
  std::vector<Index> parent;             ///< the edge towards the root, or kNone
  std::vector<std::uint8_t> is_taken;    ///< whether the cut has the path to the root
  std::vector<Index> degree;             ///< in the cut
  std::vector<Index> incident;           ///< its edges there, combined by exclusive or
  std::vector<std::uint8_t> is_in_tree;  ///< per half-edge, those of an edge alike
  // Per face: the dual graph off the tree.
  std::vector<Index> crossings;  ///< edges to faces that are not stripped
  DisjointSets sets;

  Graph(const Surface& of_surface, const BoundaryLoops& of_loops, const EdgeMarks& of_locked)
      : surface(of_surface),
        loops(of_loops),
        locked(of_locked),
        loop_of_vertex(surface.positions.size(), kNone),
        node(surface.positions.size()),
        distance(node.size()),
        parent(node.size()),
        is_taken(node.size(), 0),
        degree(node.size(), 0),
        incident(node.size(), 0),
        is_in_tree(surface.twin.size(), 0),
        crossings(surface.faces.size()),
        sets(size_of(crossings)) {
    std::iota(node.begin(), node.end(), 0);
    for (Index loop = 0; loop < loops.count(); ++loop) {
      const Index first = surface.origin(loops.halfedge[loops.start[loop]]);
      for (const Index h : halfedges_of(loop)) {
        loop_of_vertex[surface.origin(h)] = loop;
        node[surface.origin(h)] = first;
      }
    }
  }

  std::span<const Index> halfedges_of(Index loop) const {
    return std::span(loops.halfedge)
        .subspan(loops.start[loop], loops.start[loop + 1] - loops.start[loop]);
  }
  bool is_joined_loop(Index n) const { return loop_of_vertex[n] != kNone; }
  double length(Index h) const {
    return (surface.positions[surface.target(h)] - surface.positions[surface.origin(h)]).norm();
  }
  Index start_node(Index h) const { return node[surface.origin(h)]; }
  Index end_node(Index h) const { return node[surface.target(h)]; }
  Index other_end(Index h, Index n) const {
    return start_node(h) == n ? end_node(h) : start_node(h);
  }

  /// Calls visit(half-edge) once or twice for each edge at the node.
  template <class Visit>
  void for_each_edge_at(Index n, const Visit& visit) const {
    const auto at_vertex = [&](Index v) {
      surface.for_each_outgoing(v, [&](Index h) {
        visit(h);
        if (surface.rotate(h) == kNone) visit(Surface::previous(h));
      });
    };
    if (!is_joined_loop(n)) return at_vertex(n);
    for (const Index h : halfedges_of(loop_of_vertex[n])) at_vertex(surface.origin(h));
  }

  void set_in_tree(Index h, bool is) {
    is_in_tree[h] = is ? 1 : 0;
    if (surface.twin[h] != kNone) is_in_tree[surface.twin[h]] = is_in_tree[h];
  }
  /// The face beyond an edge off the tree; kNone in the tree and on loops.
  Index across(Index h) const {
    const Index twin = surface.twin[h];
    return is_in_tree[h] != 0 || twin == kNone ? kNone : twin / 3;
  }
  /// Calls visit(half-edge, other face) for each edge off the tree of a face.
  template <class Visit>
  void for_each_crossing(Index face, const Visit& visit) const {
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index other = across(h);
      if (other != kNone) visit(h, other);
    }
  }
};

/// A cut by the names of its edges.
struct Cut {
  std::vector<Index> edges;
  double length = std::numeric_limits<double>::infinity();
};

/// The search in one component.
class Opening {
 public:
  Opening(Graph& graph, const Component& component, std::span<const Index> vertices,
          std::span<const Index> faces, std::span<const Index> loops)
      : graph_(graph), component_(component), vertices_(vertices), faces_(faces) {
    for (const Index loop : loops) {
      loop_nodes_.push_back(graph.start_node(graph.halfedges_of(loop).front()));
    }
  }

  std::vector<Index> run() {
    const bool has_handles = component_.genus() > 0;
    if (!has_handles && loop_nodes_.size() == 1) return {};
    if (!has_handles && loop_nodes_.empty()) return open_sphere();
    Cut best;
    int root = 0;
    if (!loop_nodes_.empty()) {
      best = open_from(loop_nodes_);
      if (!has_handles) return std::move(best.edges);
      ++root;
    }
    // The ends of the component first, then along the best cut so far.
    const int roots = std::clamp(kRootFaces / component_.faces, kLeastRoots, kMostRoots);
    for (Index next = graph_.node[vertices_.front()]; root < roots; ++root) {
      Cut cut = open_from({next});
      const Index far = farthest();
      if (best.edges.empty() || cut.length < best.length) best = std::move(cut);
      next = root == 0 ? far : graph_.start_node(best.edges[best.edges.size() * root / roots]);
    }
    return std::move(best.edges);
  }

 private:
  void grow_tree(const std::vector<Index>& roots);
  Index farthest() const;
  Index farthest_in_space();
  std::vector<Index> open_sphere();
  Cut open_from(const std::vector<Index>& roots);
  std::vector<Index> closing_edges();
  void strip_dual();
  bool is_beyond_locks(const std::vector<Index>& closing) const;
  void take_path(Index n, std::vector<Index>& edges);
  void prune(const std::vector<Index>& roots, std::vector<Index>& edges);

  bool is_free(Index h) const {
    return !honours_locks_ || graph_.locked.empty() || !graph_.locked[h];
  }
  /// Infinite where the cut must not go: no path takes such an edge, and the spanning tree of the
  /// dual, which begins with the longest loops, crosses it.
  double length(Index h) const {
    return is_free(h) ? graph_.length(h) : std::numeric_limits<double>::infinity();
  }

  Graph& graph_;
  const Component& component_;
  std::span<const Index> vertices_;
  std::span<const Index> faces_;
  std::vector<Index> loop_nodes_;
  bool honours_locks_ = true;  ///< until no cut is found that does
  PollSometimes poll_;
};

/// Shortest paths from the nearest of the roots (Dijkstra 1959).
void Opening::grow_tree(const std::vector<Index>& roots) {
  for (const Index v : vertices_) {
    graph_.distance[v] = std::numeric_limits<double>::infinity();
    graph_.parent[v] = kNone;
  }
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const Index n : roots) {
    graph_.distance[n] = 0;
    queue.emplace(0, n);
  }
  while (!queue.empty()) {
    poll_();
    const auto [reached, n] = queue.top();
    queue.pop();
    if (reached > graph_.distance[n]) continue;
    graph_.for_each_edge_at(n, [&, reached = reached, n = n](Index h) {
      poll_();  // a hub or a loop may have all edges
      const Index other = graph_.other_end(h, n);
      const double through = reached + length(h);
      if (!(through < graph_.distance[other])) return;
      graph_.distance[other] = through;
      graph_.parent[other] = graph_.surface.edge(h);
      queue.emplace(through, other);
    });
  }
}

/// Of the nodes that paths reach.
Index Opening::farthest() const {
  Index far = graph_.node[vertices_.front()];
  for (const Index v : vertices_) {
    const Index n = graph_.node[v];
    if (graph_.parent[n] != kNone && graph_.distance[n] > graph_.distance[far]) far = n;
  }
  return far;
}

/// The vertex with a free edge that is farthest in space from the first one: as good a root as the
/// one of the longest path, for a tree less.
Index Opening::farthest_in_space() {
  const std::vector<Vec3>& positions = graph_.surface.positions;
  Index far = vertices_.front();
  double most = 0;
  for (const Index v : vertices_) {
    poll_();
    const double distance_sq = (positions[v] - positions[vertices_.front()]).squaredNorm();
    if (!(distance_sq > most)) continue;
    bool is_free = false;
    graph_.for_each_edge_at(v, [&](Index h) { is_free = is_free || this->is_free(h); });
    if (!is_free) continue;
    most = distance_sq;
    far = v;
  }
  return far;
}

/// A path of two edges or more: along one alone, the sides of a cut would be one edge.
std::vector<Index> Opening::open_sphere() {
  const Index root = farthest_in_space();
  grow_tree({root});
  // The two farthest nodes, those two edges away or more before the neighbours of the root.
  const auto rank = [&](Index n) {
    const bool is_beyond = graph_.other_end(graph_.parent[n], n) != root;
    return std::pair(is_beyond, graph_.distance[n]);
  };
  Index far = kNone, second = kNone;
  for (const Index n : vertices_) {
    poll_();
    if (n == root || graph_.parent[n] == kNone) continue;
    if (far == kNone || rank(n) > rank(far)) {
      second = std::exchange(far, n);
    } else if (second == kNone || rank(n) > rank(second)) {
      second = n;
    }
  }
  if (second == kNone) {
    honours_locks_ = false;  // a sphere has three vertices or more
    return open_sphere();
  }
  std::vector<Index> edges;
  take_path(far, edges);
  if (edges.size() == 1) take_path(second, edges);
  return edges;
}

/// A cut graph of edges of the tree from the roots and as few others as there must be, pruned.
Cut Opening::open_from(const std::vector<Index>& roots) {
  grow_tree(roots);
  const auto mark_tree = [&](bool is) {
    for (const Index v : vertices_) {
      poll_();
      if (graph_.parent[v] != kNone) graph_.set_in_tree(graph_.parent[v], is);
    }
  };
  Cut cut;
  mark_tree(true);
  cut.edges = closing_edges();
  mark_tree(false);
  if (honours_locks_ && is_beyond_locks(cut.edges)) {
    honours_locks_ = false;
    return open_from(roots);
  }
  const std::size_t closing = cut.edges.size();
  for (std::size_t i = 0; i < closing; ++i) {
    const Index h = cut.edges[i];
    take_path(graph_.start_node(h), cut.edges);
    take_path(graph_.end_node(h), cut.edges);
  }
  for (const Index n : loop_nodes_) take_path(n, cut.edges);
  for (const Index v : vertices_) graph_.is_taken[v] = 0;
  prune(roots, cut.edges);
  cut.length = 0;
  for (const Index h : cut.edges) cut.length += length(h);
  return cut;
}

/// The edges that neither the tree has nor a maximum spanning tree of the dual crosses, by the
/// length of the loop that each closes with the tree. Edges of faces that hang on one edge alone
/// are in every spanning tree: these are stripped first, and little is left to sort.
std::vector<Index> Opening::closing_edges() {
  strip_dual();
  struct Crossing {
    double loop_length;
    Index h, one, other;
  };
  std::vector<Crossing> crossings;
  for (const Index face : faces_) {
    poll_();
    if (graph_.crossings[face] == 0) continue;
    graph_.sets.make(face);
    graph_.for_each_crossing(face, [&](Index h, Index other) {
      if (graph_.crossings[other] == 0 || graph_.surface.edge(h) != h) return;
      const double loop_length =
          graph_.distance[graph_.start_node(h)] + length(h) + graph_.distance[graph_.end_node(h)];
      crossings.push_back({loop_length, h, face, other});
    });
  }
  sort_interruptibly(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.loop_length != b.loop_length ? a.loop_length > b.loop_length : a.h < b.h;
  });
  std::vector<Index> closing;
  for (const Crossing& crossing : crossings) {
    poll_();
    if (!graph_.sets.unite(crossing.one, crossing.other)) closing.push_back(crossing.h);
  }
  return closing;
}

/// Counts the edges off the tree of every face, and takes away faces with one as long as there are.
void Opening::strip_dual() {
  std::vector<Index>& count = graph_.crossings;
  std::vector<Index> leaves;
  for (const Index face : faces_) {
    poll_();
    count[face] = 0;
    graph_.for_each_crossing(face, [&](Index, Index) { ++count[face]; });
    if (count[face] == 1) leaves.push_back(face);
  }
  while (!leaves.empty()) {
    poll_();
    const Index leaf = leaves.back();
    leaves.pop_back();
    if (std::exchange(count[leaf], 0) == 0) continue;
    graph_.for_each_crossing(leaf, [&](Index, Index other) {
      if (count[other] > 0 && --count[other] == 1) leaves.push_back(other);
    });
  }
}

/// Whether the cut would have to take a locked edge, or reach what only these lead to.
bool Opening::is_beyond_locks(const std::vector<Index>& closing) const {
  const auto is_reached = [&](Index n) { return std::isfinite(graph_.distance[n]); };
  const auto can_be_cut = [&](Index h) {
    return is_free(h) && is_reached(graph_.start_node(h)) && is_reached(graph_.end_node(h));
  };
  return !std::all_of(loop_nodes_.begin(), loop_nodes_.end(), is_reached) ||
         !std::all_of(closing.begin(), closing.end(), can_be_cut);
}

void Opening::take_path(Index n, std::vector<Index>& edges) {
  while (graph_.parent[n] != kNone && graph_.is_taken[n] == 0) {
    poll_();
    graph_.is_taken[n] = 1;
    edges.push_back(graph_.parent[n]);
    n = graph_.other_end(graph_.parent[n], n);
  }
}

/// Removes what hangs loose: all edges lie on paths from the roots, so only these can be loose
/// ends.
void Opening::prune(const std::vector<Index>& roots, std::vector<Index>& edges) {
  const auto change = [&](Index n, Index h, Index by) {
    graph_.degree[n] += by;
    graph_.incident[n] ^= h;
  };
  const auto change_ends = [&](Index h, Index by) {
    change(graph_.start_node(h), h, by);
    change(graph_.end_node(h), h, by);
  };
  for (const Index h : edges) change_ends(h, 1);
  std::vector<Index> loose;
  for (Index n : roots) {
    while (graph_.degree[n] == 1 && !graph_.is_joined_loop(n)) {
      const Index h = graph_.incident[n];
      loose.push_back(h);
      change_ends(h, -1);
      n = graph_.other_end(h, n);
    }
  }
  std::sort(loose.begin(), loose.end());
  std::erase_if(edges, [&](Index h) {
    const bool is_loose = std::binary_search(loose.begin(), loose.end(), h);
    if (!is_loose) change_ends(h, -1);
    return is_loose;
  });
}

}  // namespace

EdgeMarks open_minimal(const Surface& surface, const Topology& topology, const EdgeMarks& locked,
                       const Work& work) {
  const Index components = size_of(topology.components);
  const BoundaryLoops& loops = topology.loops;
  Graph graph(surface, loops, locked);
  const auto component_of_vertex = [&](Index v) {
    const Index h = surface.outgoing[v];
    return h == kNone ? kNone : topology.component_of_face[h / 3];
  };
  const Grouping vertices(surface.vertex_count(), components, component_of_vertex, work);
  const Grouping faces(
      surface.face_count(), components, [&](Index f) { return topology.component_of_face[f]; },
      work);
  const Grouping loops_of(
      loops.count(), components, [&](Index loop) { return topology.component_of_loop[loop]; },
      work);
  std::vector<std::vector<Index>> cuts(components);
  parallel_for(work, components, 1, [&](std::int64_t begin, std::int64_t) {
    const auto c = static_cast<Index>(begin);
    Opening opening(graph, topology.components[c], vertices[c], faces[c], loops_of[c]);
    cuts[c] = opening.run();
  });
  EdgeMarks marks(surface.twin.size(), false);
  for (const std::vector<Index>& cut : cuts) {
    for (const Index h : cut) mark_edge(surface, h, marks);
  }
  return marks;
}

EdgeMarks opened_further(const Surface& surface, EdgeMarks marks, const EdgeMarks& locked,
                         const Work& work) {
  const SplitSurface parted = split_along(surface, marks, work);
  const EdgeMarks more =
      open_minimal(parted.surface, topology_of(parted.surface, work), locked, work);
  for (std::size_t h = 0; h < marks.size(); ++h) marks[h] = marks[h] || more[h];
  return marks;
}

}  // namespace beltrami
