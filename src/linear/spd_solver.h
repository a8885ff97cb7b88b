// Sparse symmetric positive definite systems behind one interface; the back end is chosen when the
// library is built (-DBELTRAMI_SOLVER=native|eigen|cholmod|cholmod-simplicial).
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "base/work.h"

namespace beltrami {

/// Compressed columns. Symmetric matrices are passed as their lower triangle, diagonal included.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using DenseMatrix = Eigen::MatrixXd;

/// Where the unknowns of a matrix are in space: only differences matter.
using Place = std::array<float, 3>;

enum class Precision {
  kDouble,
  /// Half the memory and time where the back end can: the factor is in single precision, and
  /// solve() brings the residual down to `residual` with it. For matrices that are
  /// definite by construction: whether a matrix is definite is decided in single precision first.
  kSingle,
};

/// How systems are solved. Back ends may ignore all of it.
struct SolverOptions {
  Precision precision = Precision::kDouble;
  /// What solve() takes the residual to, relative to the right-hand side, with kSingle. The default
  /// is what a map needs that is not improved further: beyond 1e-8 the set of its flipped faces
  /// depends on it.
  double residual = 5e-9;
};

/// A direct solver. The bits of a solution depend on the matrix, the places and the options, not on
/// its threads. Cancelling (base/interrupt.h) may end an analysis or a factorization; the solver
/// can be given another matrix then.
class SpdSolver {
 public:
  virtual ~SpdSolver() = default;
  /// Orders the pattern of `lower`. `places`, which may be empty: one per row, or one per block
  /// where the matrix consists of dense 2 x 2 blocks; they help to order large matrices. `order`,
  /// likewise, lists the rows or blocks as they are to be eliminated, which spares the solver the
  /// search for an order; back ends may search all the same. Throws std::bad_alloc, or Error
  /// SOLVER.
  virtual void analyze(const SparseMatrix& lower, std::span<const Place> places,
                       std::span<const int> order) = 0;
  void analyze(const SparseMatrix& lower, std::span<const Place> places) {
    analyze(lower, places, {});
  }
  void analyze(const SparseMatrix& lower) { analyze(lower, {}, {}); }
  /// Factorizes a matrix of the analyzed pattern. False: it is not positive definite in floating
  /// point.
  [[nodiscard]] virtual bool factorize(const SparseMatrix& lower) = 0;
  /// Solves for every column of `rhs` with the last factor. Throws Error SOLVER if a factor in
  /// single precision turns out to be useless and there is none in double precision.
  virtual DenseMatrix solve(const DenseMatrix& rhs) const = 0;
  /// An approximate inverse times `rhs`, for preconditioning: linear, symmetric, definite, the same
  /// until the next factorization or keep_preconditioner(). Good to single precision at least, and
  /// never slower than solve().
  virtual DenseMatrix precondition(const DenseMatrix& rhs) const { return solve(rhs); }
  /// Frees what precondition() has no use for, which is all that is called until the next analysis;
  /// that may get a little less exact.
  virtual void keep_preconditioner() {}
  /// The given rows of the solution alone, in the order of `rows`: rows(A^-1 rhs). A back end may
  /// skip the parts of the factor that neither the right-hand sides nor the rows reach;
  /// neighbouring columns should have their nonzeros close together. Same bits at any number of
  /// threads.
  virtual DenseMatrix solve_rows(const SparseMatrix& rhs, const std::vector<int>& rows) const = 0;
};

/// What solve_rows gives, by whole solves for a few columns at a time.
inline DenseMatrix rows_of_whole_solves(const SpdSolver& solver, const SparseMatrix& rhs,
                                        const std::vector<int>& rows) {
  constexpr Eigen::Index kBlock = 32;
  DenseMatrix result(static_cast<Eigen::Index>(rows.size()), rhs.cols());
  for (Eigen::Index first = 0; first < rhs.cols(); first += kBlock) {
    const Eigen::Index count = std::min(kBlock, rhs.cols() - first);
    const DenseMatrix block = solver.solve(DenseMatrix(rhs.middleCols(first, count)));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      result.row(static_cast<Eigen::Index>(i)).segment(first, count) = block.row(rows[i]);
    }
  }
  return result;
}

std::unique_ptr<SpdSolver> make_spd_solver(const SolverOptions& options, const Work& work);

/// "native", "eigen", "cholmod" or "cholmod-simplicial".
const char* spd_solver_name();

}  // namespace beltrami
