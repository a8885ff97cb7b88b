#include "linear/elimination.h"

#include <algorithm>
#include <utility>

#include "linear/cholesky/graph.h"
#include "linear/cholesky/minimum_degree.h"
#include "linear/cholesky/native_solver.h"
#include "linear/cholesky/nested_dissection.h"
#include "linear/mesh_matrix.h"

namespace beltrami {

std::vector<Index> elimination_ranks(const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& faces, const Work& work) {
  const MeshMatrix matrix(size_of(positions), faces, std::vector<bool>(positions.size(), false), 1,
                          work);
  const Graph graph = graph_of(matrix.matrix(), 1, work);
  const std::vector<int> order =
      graph.count() >= kLeastDissected
          ? nested_dissection_order(graph, matrix.places(positions), work)
          : minimum_degree_order(graph);
  std::vector<Index> ranks(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<Index>(i);
  return ranks;
}

std::vector<int> in_order(std::span<const Index> ranks, const std::vector<Index>& rows) {
  if (ranks.empty()) return {};
  std::vector<std::pair<Index, int>> ranked;
  for (std::size_t v = 0; v < rows.size(); ++v) {
    if (rows[v] != kNone) ranked.emplace_back(ranks[v], rows[v]);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> order;
  order.reserve(ranked.size());
  for (const auto& [rank, row] : ranked) order.push_back(row);
  return order;
}

}  // namespace beltrami
