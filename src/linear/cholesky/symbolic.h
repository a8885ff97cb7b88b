// What a Cholesky factor will look like: decided once per pattern, before any value is known.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/graph.h"

namespace beltrami {

/// Tasks that a factorization has at most, about: further threads find nothing to do.
inline constexpr int kMostTasks = 96;

/// The supernodes of L for a matrix of square blocks (all counts and numbers here are of block
/// rows) in the order of elimination. A supernode is a run of columns that share the rows below
/// them; stored explicitly, it holds some zeros where that costs less than one supernode more.
/// Supernodes come in the order of elimination: children before parents; first the subtrees in
/// `tasks` one after the other, which share nothing, then their common ancestors.
struct Symbolic {
  int block_size = 1;
  std::vector<int> place;                 ///< per row of the matrix: its column of L
  std::vector<int> first_column;          ///< per supernode, and one more
  std::vector<int> parent;                ///< per supernode, or -1
  std::vector<std::int64_t> row_start;    ///< per supernode, and one more
  std::vector<int> rows;                  ///< below the diagonal block of a supernode, ascending
  std::vector<std::int64_t> value_start;  ///< per supernode, and one more: scalars before its panel
  std::vector<int> child_start, child;    ///< the children of each supernode
  struct Range {
    int begin, end;  // supernodes
  };
  std::vector<Range> tasks;
  double work = 0;  ///< multiplications of the factorization with blocks of one

  int supernode_count() const { return static_cast<int>(parent.size()); }
  int column_count() const { return static_cast<int>(place.size()); }
  int columns(int s) const { return first_column[s + 1] - first_column[s]; }
  std::span<const int> rows_of(int s) const {
    return {rows.data() + row_start[s], rows.data() + row_start[s + 1]};
  }
  std::span<const int> children(int s) const {
    return {child.data() + child_start[s], child.data() + child_start[s + 1]};
  }
  /// Scalar rows of a panel, the diagonal block's included; its columns are contiguous.
  int height(int s) const {
    return block_size * (columns(s) + static_cast<int>(row_start[s + 1] - row_start[s]));
  }
  int width(int s) const { return block_size * columns(s); }
  /// The first supernode that belongs to no task.
  int top_begin() const { return tasks.empty() ? 0 : tasks.back().end; }
};

/// Elimination tree (Liu 1986), column counts (Gilbert, Ng, Peyton 1994), supernodes merged by what
/// they would cost, and their rows. `order`: see minimum_degree_order.
Symbolic analyze_pattern(const Graph& graph, const std::vector<int>& order, int block_size,
                         const Work& work);

/// The multiplications that factorizing in this order takes, as in Symbolic.
double factor_work(const Graph& graph, const std::vector<int>& order, const Work& work);

}  // namespace beltrami
