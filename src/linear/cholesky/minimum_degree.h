// Elimination orders by minimum degree: of whole graphs, and of the small parts of a dissection.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/processor.h"
#include "linear/cholesky/graph.h"

namespace beltrami {

/// Approximate minimum degree (Amestoy, Davis, Duff 1996, as copied in Eigen). The k-th entry is
/// the vertex that is eliminated k-th.
std::vector<int> minimum_degree_order(const Graph& graph);

/// Exact minimum degree on one leaf, with sets of vertices as bits. The vertices around the leaf
/// (already separators) count in the degrees, so that the leaf is eliminated from its inside out.
class LeafOrder {
 public:
  /// Reorders `vertices`. `local` is negative for them, and left so; of other vertices it is only
  /// read, since leaves that touch the same separators are at work side by side.
  void run(const Graph& graph, std::span<int> vertices, std::vector<int>& local);

 private:
  int number_around(int v);
  std::uint64_t* row(int i) { return rows_.data() + words_ * i; }
  void eliminate(std::span<int> order);
  void eliminate_popcnt(std::span<int> order);
  void eliminate_with(std::span<int> order);
  std::int16_t degree_of(int i);
  template <class Visit>
  void for_each_bit(Visit&& visit);

  const bool popcnt_ = has_popcnt();
  int count_ = 0;
  std::size_t words_ = 0;
  std::vector<int> all_, touched_;  // all_: the leaf, then what is around it
  std::vector<std::pair<int, int>> edges_;
  std::array<std::pair<int, int>, 1024> around_;  // hash table of the latter: vertex, number
  std::vector<std::uint64_t> rows_, alive_, pivot_;
  std::vector<std::int16_t> degree_;
};

}  // namespace beltrami
