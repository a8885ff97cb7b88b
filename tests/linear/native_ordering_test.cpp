// Elimination orders and what they cost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/graph.h"
#include "linear/cholesky/minimum_degree.h"
#include "linear/cholesky/nested_dissection.h"
#include "linear/cholesky/symbolic.h"
#include "linear/cholesky/vertex_separator.h"
#include "linear/spd_solver.h"
#include "support/disks.h"

namespace beltrami {
namespace {

using disks::Random;

struct PlacedGraph {
  Graph graph;
  std::vector<Place> places;
};

Graph from_edges(int n, const std::vector<std::pair<int, int>>& edges) {
  std::vector<std::vector<int>> lists(n);
  for (const auto& [a, b] : edges) {
    lists[a].push_back(b);
    lists[b].push_back(a);
  }
  Graph graph;
  graph.start.push_back(0);
  for (const auto& list : lists) {
    graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
    graph.start.push_back(static_cast<std::uint32_t>(graph.neighbour.size()));
  }
  return graph;
}

/// A triangulated grid, bent over a bumpy surface.
PlacedGraph surface(int nx, int ny) {
  PlacedGraph result;
  std::vector<std::pair<int, int>> edges;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      const int v = x + nx * y;
      if (x + 1 < nx) edges.emplace_back(v, v + 1);
      if (y + 1 < ny) edges.emplace_back(v, v + nx);
      if (x + 1 < nx && y + 1 < ny) edges.emplace_back(v, v + nx + 1);
      const float a = 0.02F * static_cast<float>(x), b = 0.02F * static_cast<float>(y);
      result.places.push_back({a, b, std::sin(3 * a) * std::cos(2 * b)});
    }
  }
  result.graph = from_edges(nx * ny, edges);
  return result;
}

bool is_permutation_of_all(std::vector<int> order, int n) {
  std::sort(order.begin(), order.end());
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  return order == all;
}

TEST(Ordering, DissectsSurfacesAtLessWorkThanMinimumDegree) {
  const PlacedGraph mesh = surface(210, 200);
  const auto order = nested_dissection_order(mesh.graph, mesh.places, Work(1));
  ASSERT_TRUE(is_permutation_of_all(order, mesh.graph.count()));
  EXPECT_LT(factor_work(mesh.graph, order, Work(1)),
            factor_work(mesh.graph, minimum_degree_order(mesh.graph), Work(1)));
}

TEST(Ordering, DissectsInTheSameOrderAtAnyNumberOfThreads) {
  const PlacedGraph mesh = surface(150, 140);
  const auto order = nested_dissection_order(mesh.graph, mesh.places, Work(1));
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(order, nested_dissection_order(mesh.graph, mesh.places, Work(threads)));
  }
}

TEST(Ordering, DissectsAnyGraphWithAnyPlaces) {
  Random random(31);
  std::vector<Graph> graphs;
  graphs.push_back(from_edges(0, {}));
  graphs.push_back(from_edges(1, {}));
  graphs.push_back(from_edges(3000, {}));  // no edges at all
  graphs.push_back(surface(60, 60).graph);
  std::vector<std::pair<int, int>> star, complete, scattered;
  for (int i = 1; i < 3000; ++i) star.emplace_back(0, i);
  for (int i = 0; i < 700; ++i) {
    for (int j = 0; j < i; ++j) complete.emplace_back(i, j);
  }
  for (int i = 0; i < 9000; ++i) {
    const int a = random.below(3000), b = random.below(3000);
    if (a != b) scattered.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(scattered.begin(), scattered.end());
  scattered.erase(std::unique(scattered.begin(), scattered.end()), scattered.end());
  graphs.push_back(from_edges(3000, star));
  graphs.push_back(from_edges(700, complete));
  graphs.push_back(from_edges(3000, scattered));
  for (const Graph& graph : graphs) {
    std::vector<Place> same(graph.count(), Place{1, 2, 3}), noise(graph.count()),
        line(graph.count());
    for (int v = 0; v < graph.count(); ++v) {
      for (float& x : noise[v]) x = static_cast<float>(random.between(-1, 1));
      line[v] = {1e30F * static_cast<float>(v), 0, 0};
    }
    for (const auto& places : {same, noise, line}) {
      const auto order = nested_dissection_order(graph, places, Work(2));
      EXPECT_TRUE(is_permutation_of_all(order, graph.count()));
    }
  }
}

TEST(Ordering, DissectsAHubWithNeighboursInManyChunks) {
  constexpr int kCount = 100'000;
  std::vector<std::pair<int, int>> star;
  for (int i = 1; i < kCount; ++i) star.emplace_back(0, i);
  const Graph graph = from_edges(kCount, star);
  std::vector<Place> line(kCount, Place{});
  for (int v = 0; v < kCount; ++v) line[v][0] = static_cast<float>(v);
  const auto order = nested_dissection_order(graph, line, Work(2));
  EXPECT_TRUE(is_permutation_of_all(order, kCount));
}

TEST(Ordering, SeesBlocksOfTwoOnlyWhereAllIsInBlocks) {
  SparseMatrix lower(4, 4);
  for (int c = 0; c < 4; ++c) {
    for (int r = c; r < 4; ++r) lower.insert(r, c) = 1;
  }
  lower.makeCompressed();
  EXPECT_EQ(block_size_of(lower), 2);
  EXPECT_EQ(graph_of(lower, 2, Work(1)).count(), 2);
  EXPECT_EQ(graph_of(lower, 2, Work(1)).neighbour.size(), 2U);
  lower.prune([](int r, int c, double) { return r != 3 || c != 0; });
  EXPECT_EQ(block_size_of(lower), 1);
}

/// The rows of L by elimination as in a textbook: sets of vertices.
double work_by_hand(const Graph& graph, const std::vector<int>& order) {
  const int n = graph.count();
  std::vector<int> place(n);
  for (int i = 0; i < n; ++i) place[order[i]] = i;
  std::vector<std::vector<bool>> below(n, std::vector<bool>(n, false));
  double work = 0;
  for (int k = 0; k < n; ++k) {
    for (const int w : graph.neighbours(order[k])) {
      if (place[w] > k) below[k][place[w]] = true;
    }
    int count = 1, parent = -1;
    for (int i = k + 1; i < n; ++i) {
      if (!below[k][i]) continue;
      ++count;
      if (parent < 0) parent = i;
    }
    for (int i = parent + 1; parent >= 0 && i < n; ++i) {
      if (below[k][i]) below[parent][i] = true;
    }
    work += static_cast<double>(count) * count;
  }
  return work;
}

TEST(Symbolic, CountsTheEntriesOfTheFactor) {
  Random random(32);
  for (int round = 0; round < 30; ++round) {
    const int n = 1 + random.below(60);
    std::vector<std::pair<int, int>> edges;
    for (int i = 0; i < random.below(4 * n); ++i) {
      const int a = random.below(n), b = random.below(n);
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const Graph graph = from_edges(n, edges);
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    for (int i = n; i-- > 1;) std::swap(order[i], order[random.below(i + 1)]);
    EXPECT_EQ(factor_work(graph, order, Work(1)), work_by_hand(graph, order));
  }
}

TEST(Symbolic, HasSupernodesWhoseRowsAreColumnsOfTheirAncestors) {
  const PlacedGraph mesh = surface(90, 80);
  for (const auto& order : {nested_dissection_order(mesh.graph, mesh.places, Work(1)),
                            minimum_degree_order(mesh.graph)}) {
    const Symbolic symbolic = analyze_pattern(mesh.graph, order, 1, Work(1));
    EXPECT_TRUE(is_permutation_of_all(symbolic.place, mesh.graph.count()));
    EXPECT_EQ(symbolic.first_column.back(), mesh.graph.count());
    EXPECT_FALSE(symbolic.tasks.empty());
    for (int s = 0; s < symbolic.supernode_count(); ++s) {
      const auto rows = symbolic.rows_of(s);
      EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
      const int parent = symbolic.parent[s];
      EXPECT_EQ(parent < 0, rows.empty());
      if (parent < 0) continue;
      ASSERT_GT(parent, s);
      EXPECT_GE(rows.front(), symbolic.first_column[parent]);
      EXPECT_LT(rows.front(), symbolic.first_column[parent + 1]);
      for (const int row : rows) {
        const auto above = symbolic.rows_of(parent);
        EXPECT_TRUE(row < symbolic.first_column[parent + 1] ||
                    std::binary_search(above.begin(), above.end(), row));
      }
    }
  }
}

/// The size of the smallest separator of a random graph, by trying all sets.
int smallest_by_hand(const VertexSeparator& graph) {
  const int n = static_cast<int>(graph.terminal.size());
  int best = n;
  for (unsigned removed = 0; removed < 1U << n; ++removed) {
    std::vector<int> stack;
    unsigned seen = removed;
    const auto visit = [&](int v) {
      if ((seen >> v & 1U) != 0) return;
      seen |= 1U << v;
      stack.push_back(v);
    };
    for (int v = 0; v < n; ++v) {
      if ((graph.terminal[v] & VertexSeparator::kSource) != 0) visit(v);
    }
    bool through = false;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      through = through || (graph.terminal[v] & VertexSeparator::kSink) != 0;
      for (int e = graph.start[v]; e < graph.start[v + 1]; ++e) visit(graph.neighbour[e]);
    }
    if (!through) best = std::min(best, __builtin_popcount(removed));
  }
  return best;
}

TEST(VertexSeparator, FindsTheSmallestCut) {
  Random random(33);
  for (int round = 0; round < 300; ++round) {
    const int n = 1 + random.below(10);
    std::vector<std::pair<int, int>> edges;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < a; ++b) {
        if (random.below(10) < 3) edges.emplace_back(a, b);
      }
    }
    const Graph graph = from_edges(n, edges);
    VertexSeparator separator;
    separator.start.assign(graph.start.begin(), graph.start.end());
    separator.neighbour = graph.neighbour;
    for (int v = 0; v < n; ++v) {
      separator.terminal.push_back(
          static_cast<std::uint8_t>((random.below(3) == 0 ? VertexSeparator::kSource : 0) |
                                    (random.below(3) == 0 ? VertexSeparator::kSink : 0)));
    }
    const auto& side = separator.cut(random.below(5), random.below(5));
    int size = 0;
    for (int v = 0; v < n; ++v) {
      if (side[v] == VertexSeparator::kSeparator) ++size;
      if (side[v] == VertexSeparator::kSourceSide) {
        EXPECT_EQ(separator.terminal[v] & VertexSeparator::kSink, 0);
      }
      if (side[v] == VertexSeparator::kSinkSide) {
        EXPECT_EQ(separator.terminal[v] & VertexSeparator::kSource, 0);
      }
      for (int e = separator.start[v]; e < separator.start[v + 1]; ++e) {
        EXPECT_FALSE(side[v] == VertexSeparator::kSourceSide &&
                     side[separator.neighbour[e]] == VertexSeparator::kSinkSide);
      }
    }
    EXPECT_EQ(size, smallest_by_hand(separator));
  }
}

}  // namespace
}  // namespace beltrami
