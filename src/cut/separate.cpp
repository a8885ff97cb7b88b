#include "cut/separate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "cut/join_loops.h"
#include "cut/max_flow.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Parts of more faces are cut by this many patches first: flows take longer than linear time.
constexpr Index kFineFaces = 40'000, kPatches = 16'384;
/// Patches on either side of a cut by patches in which it is sought face by face.
constexpr int kBandWidth = 2;
/// What is to be cut near the sheets counts up to 1 + kNearby times, falling off over kReach of the
/// square root of the area.
constexpr double kNearby = 2, kReach = 0.08;
/// Of the area: what smaller sheets grow to; and how much farther the other sheet must be.
constexpr double kLeastSheet = 0.01, kRoom = 3;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The dual graph of a part with some of its faces as one node.
struct DualGraph {
  std::vector<Index> node;          ///< per face
  std::vector<Terminal> terminals;  ///< per node
  std::vector<FlowEdge> edges;      ///< each pair once, with the cost of all edges between them
  std::vector<double> area;         ///< in space, per node
  std::vector<Vec3> centre;

  Index count() const { return size_of(terminals); }
};

/// Faces on both sides of a locked edge are in one node, and those for which together(half-edge)
/// holds. A node with faces of both sheets belongs to neither.
template <class Together>
DualGraph graph_of(const Part& part, const std::vector<Terminal>& of_face,
                   const Together& together) {
  const DiskMesh& mesh = part.mesh;
  PollSometimes poll;
  DisjointSets sets(mesh.face_count());
  for (Index f = 0; f < mesh.face_count(); ++f) sets.make(f);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    poll();
    if (mesh.twin[h] <= h) continue;
    if (part.cost[h] == kFar || together(h)) sets.unite(h / 3, mesh.twin[h] / 3);
  }
  DualGraph graph;
  graph.node.resize(mesh.faces.size());
  std::vector<bool> is_torn;  // between the sheets
  for (Index f = 0; f < mesh.face_count(); ++f) {
    poll();
    const Index root = sets.root(f);  // no greater than f
    if (root == f) {
      graph.node[f] = graph.count();
      graph.terminals.push_back(Terminal::kNeither);
      graph.area.push_back(0);
      graph.centre.push_back(Vec3::Zero());
      is_torn.push_back(false);
    }
    const Index n = graph.node[f] = graph.node[root];
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    const double area = triangle_area(p, q, r);
    graph.area[n] += area;
    graph.centre[n] += area * (p + q + r) / 3;
    if (of_face[f] != Terminal::kNeither && !is_torn[n]) {
      is_torn[n] = graph.terminals[n] != Terminal::kNeither && graph.terminals[n] != of_face[f];
      graph.terminals[n] = is_torn[n] ? Terminal::kNeither : of_face[f];
    }
  }
  for (Index n = 0; n < graph.count(); ++n) {
    if (graph.area[n] > 0) graph.centre[n] /= graph.area[n];
  }
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    poll();
    if (mesh.twin[h] <= h) continue;
    const auto [low, high] = std::minmax(graph.node[h / 3], graph.node[mesh.twin[h] / 3]);
    if (low != high) graph.edges.push_back({low, high, part.cost[h]});
  }
  return graph;
}

/// Edges between the same two nodes as one.
void add_up_edges(std::vector<FlowEdge>& edges) {
  const auto key = [](const FlowEdge& edge) { return std::pair(edge.one, edge.other); };
  PollSometimes poll;
  std::stable_sort(edges.begin(), edges.end(), [&](const FlowEdge& a, const FlowEdge& b) {
    poll();
    return key(a) < key(b);
  });
  std::size_t count = 0;
  for (const FlowEdge& edge : edges) {
    if (count > 0 && key(edges[count - 1]) == key(edge)) {
      edges[count - 1].capacity += edge.capacity;
    } else {
      edges[count++] = edge;
    }
  }
  edges.resize(count);
}

/// Every face for itself, or patches of faces in one cell of a grid over the map and in one sheet.
DualGraph patches_of(const Part& part, const std::vector<Terminal>& of_face) {
  const DiskMesh& mesh = part.mesh;
  if (mesh.face_count() <= kFineFaces) {
    return graph_of(part, of_face, [](Index) { return false; });
  }
  double area = 0;
  std::vector<std::array<std::int64_t, 2>> cells(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec2 u = part.uvs[b] - part.uvs[a], v = part.uvs[c] - part.uvs[a];
    area += std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
  }
  const double scale = area > 0 ? std::sqrt(kPatches / area) / 3 : 0;  // of the sum of three
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec2 cell = (part.uvs[a] + part.uvs[b] + part.uvs[c]) * scale;
    for (int k = 0; k < 2; ++k) cells[f][k] = static_cast<std::int64_t>(std::floor(cell[k]));
  }
  DualGraph graph = graph_of(part, of_face, [&](Index h) {
    const Index f = h / 3, g = mesh.twin[h] / 3;
    return cells[f] == cells[g] && of_face[f] == of_face[g];
  });
  add_up_edges(graph.edges);
  return graph;
}

/// Shortest ways over the nodes' centres.
class Ways {
 public:
  explicit Ways(const DualGraph& graph) : graph_(graph), start_(graph.terminals.size() + 1, 0) {
    for (const FlowEdge& edge : graph.edges) {
      ++start_[edge.one + 1];
      ++start_[edge.other + 1];
    }
    for (std::size_t n = 1; n < start_.size(); ++n) start_[n] += start_[n - 1];
    neighbours_.resize(2 * graph.edges.size());
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    for (const FlowEdge& edge : graph.edges) {
      neighbours_[next[edge.one]++] = edge.other;
      neighbours_[next[edge.other]++] = edge.one;
    }
  }

  /// Distances from the nodes of a sheet (Dijkstra 1959).
  std::vector<double> distances(Terminal sheet) const {
    std::vector<double> distance(graph_.terminals.size(), kFar);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (Index n = 0; n < graph_.count(); ++n) {
      if (graph_.terminals[n] != sheet) continue;
      distance[n] = 0;
      queue.emplace(0, n);
    }
    PollSometimes poll;
    while (!queue.empty()) {
      const auto [reached, n] = queue.top();
      queue.pop();
      if (reached > distance[n]) continue;
      for (Index i = start_[n]; i < start_[n + 1]; ++i) {
        poll();
        const Index other = neighbours_[i];
        const double through = reached + (graph_.centre[other] - graph_.centre[n]).norm();
        if (!(through < distance[other])) continue;
        distance[other] = through;
        queue.emplace(through, other);
      }
    }
    return distance;
  }

 private:
  const DualGraph& graph_;
  std::vector<Index> start_, neighbours_;
};

/// Takes nodes around a small sheet into it, and makes `own` the distances from what it has become.
void grow(DualGraph& graph, Terminal sheet, double wanted, std::vector<double>& own,
          const std::vector<double>& other) {
  double area = 0;
  std::vector<std::pair<double, Index>> around;
  for (Index n = 0; n < graph.count(); ++n) {
    if (graph.terminals[n] == sheet) area += graph.area[n];
    if (graph.terminals[n] == Terminal::kNeither && own[n] * kRoom < other[n]) {
      around.emplace_back(own[n], n);
    }
  }
  if (area >= wanted) return;
  sort_interruptibly(around.begin(), around.end(), std::less<>());
  double radius = 0;
  for (const auto& [distance, n] : around) {
    if (area >= wanted) break;
    graph.terminals[n] = sheet;
    area += graph.area[n];
    radius = distance;
  }
  for (double& distance : own) distance = std::max(distance - radius, 0.0);
}

/// A search for the best cut between two sheets of a part.
class Search {
 public:
  Search(const Part& part, const Sheets& sheets, const Work& work)
      : part_(part), of_face_(sheets.terminals), graph_(patches_of(part, of_face_)), work_(work) {}

  Separation run(bool is_band) {
    const std::vector<Terminal>& terminals = graph_.terminals;
    for (const Terminal side : {Terminal::kSource, Terminal::kSink}) {
      if (std::find(terminals.begin(), terminals.end(), side) == terminals.end()) return {};
    }
    const Ways ways(graph_);
    std::vector<double> source = ways.distances(Terminal::kSource);
    std::vector<double> sink = ways.distances(Terminal::kSink);
    double area = 0;
    for (const double of_node : graph_.area) area += of_node;
    const std::vector<double> before = source;
    grow(graph_, Terminal::kSource, kLeastSheet * area, source, sink);
    grow(graph_, Terminal::kSink, kLeastSheet * area, sink, before);
    factor_.resize(source.size());
    for (std::size_t n = 0; n < factor_.size(); ++n) {
      // The other end of a band is as well cut off as late as can be: more of it fits.
      const double distance = is_band ? source[n] : std::min(source[n], sink[n]);
      factor_[n] = 1 + kNearby * portable::exp(-distance / (kReach * std::sqrt(area)));
    }
    return cut();
  }

 private:
  Separation cut() const;
  void refine(const std::vector<bool>& is_source_node, std::vector<bool>& is_source_face) const;

  double factor(Index one, Index other) const { return (factor_[one] + factor_[other]) / 2; }

  const Part& part_;
  std::vector<Terminal> of_face_;
  DualGraph graph_;
  std::vector<double> factor_;  // per node, of what edges there cost
  const Work& work_;
};

/// The least cut between the terminals of the graph, and what makes disks of its pieces.
Separation Search::cut() const {
  std::vector<FlowEdge> edges = graph_.edges;
  for (FlowEdge& edge : edges) edge.capacity *= factor(edge.one, edge.other);
  const std::vector<bool> sides = least_cut(graph_.terminals, edges);
  const DiskMesh& mesh = part_.mesh;
  std::vector<bool> is_source(mesh.faces.size());
  for (Index f = 0; f < mesh.face_count(); ++f) is_source[f] = sides[graph_.node[f]];
  if (mesh.face_count() > kFineFaces) refine(sides, is_source);

  Separation result;
  result.marks.assign(mesh.twin.size(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index twin = mesh.twin[h];
    if (twin != kNone && is_source[h / 3] != is_source[twin / 3]) result.marks[h] = true;
  }
  if (!join_loops(mesh, part_.cost, result.marks, work_)) return {};
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    if (result.marks[h] && mesh.edge(h) == h) result.cost += part_.cost[h];
  }
  return result;
}

/// The cut by patches again by the faces of the patches around it.
void Search::refine(const std::vector<bool>& is_source_node,
                    std::vector<bool>& is_source_face) const {
  std::vector<int> steps(graph_.terminals.size(), kBandWidth + 1);
  for (const FlowEdge& edge : graph_.edges) {
    if (is_source_node[edge.one] != is_source_node[edge.other]) {
      steps[edge.one] = steps[edge.other] = 1;
    }
  }
  for (int step = 2; step <= kBandWidth; ++step) {
    for (const FlowEdge& edge : graph_.edges) {
      if (steps[edge.one] == step - 1) steps[edge.other] = std::min(steps[edge.other], step);
      if (steps[edge.other] == step - 1) steps[edge.one] = std::min(steps[edge.one], step);
    }
  }
  const DiskMesh& mesh = part_.mesh;
  const auto side = [](bool is_source) { return is_source ? Terminal::kSource : Terminal::kSink; };
  std::vector<Index> number(mesh.faces.size(), kNone), band;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index n = graph_.node[f];
    if (graph_.terminals[n] != Terminal::kNeither || steps[n] > kBandWidth) continue;
    number[f] = size_of(band);
    band.push_back(f);
  }
  // The faces of the band by themselves, and what is on either side as a node each.
  const Index sources = size_of(band), sinks = sources + 1;
  const auto node = [&](Index f) {
    if (number[f] != kNone) return number[f];
    return is_source_node[graph_.node[f]] ? sources : sinks;
  };
  std::vector<Terminal> terminals(band.size(), Terminal::kNeither);
  terminals.push_back(side(true));
  terminals.push_back(side(false));
  std::vector<FlowEdge> edges;
  double sum = 0;
  for (const Index f : band) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index twin = mesh.twin[h];
      if (twin == kNone || (number[twin / 3] != kNone && twin < h)) continue;
      edges.push_back({number[f], node(twin / 3),
                       part_.cost[h] * factor(graph_.node[f], graph_.node[twin / 3])});
      if (part_.cost[h] != kFar) sum += edges.back().capacity;
    }
  }
  // The cut by patches takes no locked edge, so there is one for less than all others together.
  for (FlowEdge& edge : edges) edge.capacity = std::min(edge.capacity, 2 * sum);
  const std::vector<bool> sides = least_cut(terminals, edges);
  for (const Index f : band) is_source_face[f] = sides[number[f]];
}

}  // namespace

Separation separate(const Part& part, const Sheets& sheets, const Work& work) {
  return Search(part, sheets, work).run(sheets.is_band);
}

}  // namespace beltrami
