// Undirected graphs, as orderings and the symbolic factorization see a sparse matrix.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/work.h"
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

/// A graph of connected clusters of vertices of another one.
struct ClusterGraph {
  Graph graph;
  std::vector<int> cluster;  ///< per vertex of the other graph
};

/// The size of the dense square blocks that the whole matrix consists of: 1 or 2.
int block_size_of(const SparseMatrix& lower);

/// The graph of a lower triangle; with blocks of two, one vertex per block.
Graph graph_of(const SparseMatrix& lower, int block_size, const Work& work);

/// The same graph with vertex order[i] as vertex i.
Graph renumber(const Graph& graph, const std::vector<int>& order, const Work& work);

/// Puts each vertex that is left together with its neighbours that are left: about five each. No
/// cluster reaches from one chunk of vertices into another, so that chunks go side by side: the
/// same clusters at any number of threads.
ClusterGraph coarsen(const Graph& graph, const Work& work);

}  // namespace beltrami
