// Elimination orders of sparse symmetric matrices: what decides how much a factor costs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linear/spd_solver.h"

namespace beltrami {

/// An undirected graph without loops; every edge is stored at both of its ends.
struct Graph {
  std::vector<std::uint32_t> start;  ///< count() + 1; unsigned holds two times any 32-bit pattern
  std::vector<int> neighbour;

  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> neighbours(int v) const {
    return {neighbour.data() + start[v], neighbour.data() + start[v + 1]};
  }
};

/// The size of the dense square blocks that the whole matrix consists of: 1 or 2.
int block_size_of(const SparseMatrix& lower);

/// The graph of a lower triangle; with blocks of two, one vertex per block.
Graph graph_of(const SparseMatrix& lower, int block_size, int threads);

/// The same graph with vertex order[i] as vertex i.
Graph renumber(const Graph& graph, const std::vector<int>& order, int threads);

/// Approximate minimum degree (Amestoy, Davis, Duff 1996, as copied in Eigen). The k-th entry is
/// the vertex that is eliminated k-th.
std::vector<int> minimum_degree_order(const Graph& graph);

/// Nested dissection (George 1973) by planes through `places`, one per vertex: near each plane the
/// smallest vertex separator is found as a minimum cut, and small parts are ordered by minimum
/// degree. Places that say nothing about the graph make the order worse, never wrong. Fastest where
/// vertices with numbers close together are close together: memory is walked in that order. The
/// same order at any number of threads. Precondition: places are finite.
std::vector<int> nested_dissection_order(const Graph& graph, std::span<const Place> places,
                                         int threads, const Poll& poll);

}  // namespace beltrami
