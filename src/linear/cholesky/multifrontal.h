// The multifrontal Cholesky factorization (Duff & Reid 1983; Liu 1992) and solves with the factor.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/front.h"
#include "linear/cholesky/large_array.h"
#include "linear/cholesky/symbolic.h"
#include "linear/spd_solver.h"

namespace beltrami {

/// The entries of a symmetric matrix by columns of L: in each column the rows from the diagonal
/// down, unordered, as scalars.
struct PermutedPattern {
  std::vector<int> start;   ///< per column, and one more
  std::vector<int> row;     ///< per entry
  std::vector<int> source;  ///< per entry: where its value is in the matrix

  int count() const { return static_cast<int>(start.size()) - 1; }
};

PermutedPattern permute_pattern(const SparseMatrix& lower, const Symbolic& symbolic,
                                const Work& work);

/// L, for one kind of numbers. Each front is a dense matrix that is made by one thread, or by
/// several that share nothing, in an order given by the tree: the same bits at any number of
/// threads.
template <class T>
class Factor {
 public:
  explicit Factor(front::Vectors vectors) : vectors_(vectors) {}

  /// `values`: per entry of the pattern. False if a pivot is not positive. The memory of the last
  /// factor is used again.
  [[nodiscard]] bool factorize(const Symbolic& symbolic, const PermutedPattern& pattern,
                               const T* values, const Work& work);

  /// x = A^-1 x for `columns` right-hand sides, one after the other, in the order of L.
  void solve(const Symbolic& symbolic, T* x, int columns, const Work& work) const;

  /// rows(A^-1 rhs), in the order of the matrix, like SpdSolver::solve_rows. Only the supernodes
  /// that right-hand sides or wanted rows reach are visited.
  DenseMatrix solve_rows(const Symbolic& symbolic, const SparseMatrix& rhs,
                         const std::vector<int>& rows, const Work& work) const;

  /// The panels of the supernodes, at symbolic.value_start.
  const T* panels() const { return values_.get(); }

  bool empty() const { return values_ == nullptr; }
  void clear() {
    values_.reset();
    capacity_ = 0;
  }

 private:
  front::Vectors vectors_;
  LargeArray<T> values_;
  std::int64_t capacity_ = 0;
};

}  // namespace beltrami
