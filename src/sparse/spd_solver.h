// Sparse symmetric positive definite systems behind one interface; the back end is chosen when the
// library is built (-DBELTRAMI_SOLVER=eigen|cholmod).
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace beltrami {

/// Compressed columns. Symmetric matrices are passed as their lower triangle, diagonal included.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using DenseMatrix = Eigen::MatrixXd;

/// A direct solver with an approximate minimum degree (AMD) ordering: METIS costs more than it
/// saves where a pattern is factorized only a few times. The bits of a solution depend on the
/// matrix only, not on the number of threads.
class SpdSolver {
 public:
  virtual ~SpdSolver() = default;
  /// Orders the pattern of `lower`. Throws std::bad_alloc, or Error SOLVER.
  virtual void analyze(const SparseMatrix& lower) = 0;
  /// Factorizes a matrix of the analyzed pattern. False: it is not positive definite in floating
  /// point.
  [[nodiscard]] virtual bool factorize(const SparseMatrix& lower) = 0;
  /// Solves for every column of `rhs` with the last factor.
  virtual DenseMatrix solve(const DenseMatrix& rhs) const = 0;
  /// The given rows of the solution alone, in the order of `rows`: rows(A^-1 rhs). A back end may
  /// skip the parts of the factor that neither the right-hand sides nor the rows reach;
  /// neighbouring columns should have their nonzeros close together. Same bits at any number of
  /// threads.
  virtual DenseMatrix solve_rows(const SparseMatrix& rhs, const std::vector<int>& rows,
                                 int threads) const = 0;
};

std::unique_ptr<SpdSolver> make_spd_solver();

/// "eigen" or "cholmod".
const char* spd_solver_name();

}  // namespace beltrami
