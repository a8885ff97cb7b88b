#include <Eigen/SparseCholesky>

#include "sparse/spd_solver.h"

namespace beltrami {
namespace {

class EigenSolver final : public SpdSolver {
 public:
  void analyze(const SparseMatrix& lower) override { factor_.analyzePattern(lower); }

  bool factorize(const SparseMatrix& lower) override {
    factor_.factorize(lower);
    return factor_.info() == Eigen::Success;
  }

  DenseMatrix solve(const DenseMatrix& rhs) const override { return factor_.solve(rhs); }

 private:
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor_;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver() { return std::make_unique<EigenSolver>(); }

const char* spd_solver_name() { return "eigen"; }

}  // namespace beltrami
