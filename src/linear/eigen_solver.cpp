#include <Eigen/SparseCholesky>
#include <algorithm>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

/// Solves with the factor L of P A P^T = L L^T for some rows only. The elimination tree, whose
/// parent of j is the first row below the diagonal in column j of L, tells what matters: forward a
/// right-hand side touches the ancestors of its nonzeros only, backward a row of the solution needs
/// its ancestors only (Gilbert & Peierls 1988; Davis 2006, chapter 3). Operations and their order
/// are those of the full solve, so the rows have the same bits.
class PrunedSolve {
 public:
  PrunedSolve(const SparseMatrix& factor, const Eigen::VectorXi& place, const SparseMatrix& rhs,
              const std::vector<int>& rows)
      : factor_(factor),
        place_(place),
        rhs_(rhs),
        rows_(rows),
        slot_(static_cast<std::size_t>(factor.cols()), kUnused) {
    // First the wanted rows and their ancestors, then what only right-hand sides reach.
    for (const int row : rows_) mark_ancestors(place_[row], kWanted);
    for (Eigen::Index e = 0; e < rhs_.nonZeros(); ++e) {
      mark_ancestors(place_[rhs_.innerIndexPtr()[e]], kReached);
    }
    for (int j = 0; j < factor_.cols(); ++j) {
      if (slot_[j] == kUnused) continue;
      wanted_.push_back(slot_[j] == kWanted);
      slot_[j] = static_cast<int>(columns_.size());
      columns_.push_back(j);
    }
  }

  /// Columns [first, first + count) of the result; count <= kBlock.
  void run(Eigen::Index first, Eigen::Index count, DenseMatrix& result) const {
    std::vector<double> work(columns_.size() * kBlock, 0.0);
    std::vector<bool> reached(columns_.size(), false);
    for (Eigen::Index c = 0; c < count; ++c) {
      for (SparseMatrix::InnerIterator entry(rhs_, first + c); entry; ++entry) {
        int j = place_[entry.row()];
        work[slot_[j] * kBlock + c] += entry.value();
        for (; j != kRoot && !reached[slot_[j]]; j = parent(j)) reached[slot_[j]] = true;
      }
    }
    forward(reached, work);
    backward(work);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double* values = &work[slot_[place_[rows_[i]]] * kBlock];
      for (Eigen::Index c = 0; c < count; ++c) {
        result(static_cast<Eigen::Index>(i), first + c) = values[c];
      }
    }
  }

  /// Columns that are solved together: each entry of the factor is loaded once for all of them.
  static constexpr Eigen::Index kBlock = 16;

 private:
  using Lane = Eigen::Map<Eigen::Array<double, kBlock, 1>>;
  enum : int { kUnused = -1, kWanted = -2, kReached = -3 };
  static constexpr int kRoot = -1;

  int parent(int column) const {
    const int below = factor_.outerIndexPtr()[column] + 1;
    return below < factor_.outerIndexPtr()[column + 1] ? factor_.innerIndexPtr()[below] : kRoot;
  }

  void mark_ancestors(int j, int mark) {
    for (; j != kRoot && slot_[j] == kUnused; j = parent(j)) slot_[j] = mark;
  }

  void forward(const std::vector<bool>& reached, std::vector<double>& work) const {
    for (std::size_t s = 0; s < columns_.size(); ++s) {
      if (!reached[s]) continue;
      const int begin = factor_.outerIndexPtr()[columns_[s]];
      const int end = factor_.outerIndexPtr()[columns_[s] + 1];
      Lane source(&work[s * kBlock]);
      source /= factor_.valuePtr()[begin];
      for (int p = begin + 1; p < end; ++p) {
        Lane target(&work[slot_[factor_.innerIndexPtr()[p]] * kBlock]);
        target -= source * factor_.valuePtr()[p];
      }
    }
  }

  void backward(std::vector<double>& work) const {
    for (std::size_t s = columns_.size(); s-- > 0;) {
      if (!wanted_[s]) continue;
      const int begin = factor_.outerIndexPtr()[columns_[s]];
      const int end = factor_.outerIndexPtr()[columns_[s] + 1];
      Lane target(&work[s * kBlock]);
      Eigen::Array<double, kBlock, 1> sum = target;
      for (int p = begin + 1; p < end; ++p) {
        sum -= factor_.valuePtr()[p] * Lane(&work[slot_[factor_.innerIndexPtr()[p]] * kBlock]);
      }
      target = sum / factor_.valuePtr()[begin];
    }
  }

  const SparseMatrix& factor_;
  const Eigen::VectorXi& place_;  // per row of A: its place in the factor
  const SparseMatrix& rhs_;
  const std::vector<int>& rows_;
  std::vector<int> slot_;     // per column of the factor: its rank among `columns_`
  std::vector<int> columns_;  // of the factor that matter, ascending
  std::vector<bool> wanted_;  // per entry of `columns_`: whether the backward solve needs it
};

class EigenSolver final : public SpdSolver {
 public:
  explicit EigenSolver(const Work& work) : work_(work) {}

  void analyze(const SparseMatrix& lower, std::span<const Place> /*places*/,
               std::span<const int> /*order*/) override {
    factor_.analyzePattern(lower);
  }

  bool factorize(const SparseMatrix& lower) override {
    factor_.factorize(lower);
    return factor_.info() == Eigen::Success;
  }

  /// What Eigen's own solve does, one column and one triangle at a time, so that a request to
  /// cancel is heard in between.
  DenseMatrix solve(const DenseMatrix& rhs) const override {
    DenseMatrix result(rhs.rows(), rhs.cols());
    for (Eigen::Index c = 0; c < rhs.cols(); ++c) {
      Eigen::VectorXd column = factor_.permutationP() * rhs.col(c);
      poll_interrupt();
      factor_.matrixL().solveInPlace(column);
      poll_interrupt();
      factor_.matrixU().solveInPlace(column);
      result.col(c) = factor_.permutationPinv() * column;
    }
    return result;
  }

  DenseMatrix solve_rows(const SparseMatrix& rhs, const std::vector<int>& rows) const override {
    DenseMatrix result(static_cast<Eigen::Index>(rows.size()), rhs.cols());
    if (rows.empty() || rhs.cols() == 0) return result;
    const auto lower = factor_.matrixL();
    const Eigen::VectorXi place = factor_.permutationP().indices();
    const PrunedSolve pruned(lower.nestedExpression(), place, rhs, rows);
    parallel_for(work_, rhs.cols(), PrunedSolve::kBlock, [&](std::int64_t begin, std::int64_t end) {
      pruned.run(begin, end - begin, result);
    });
    return result;
  }

 private:
  const Work work_;
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor_;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver(const SolverOptions& /*options*/, const Work& work) {
  return std::make_unique<EigenSolver>(work);
}

const char* spd_solver_name() {
  return "eigen";
}

}  // namespace beltrami
