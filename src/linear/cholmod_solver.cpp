#include <cholmod.h>

#include <algorithm>
#include <new>

#include "base/error.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

// The supernodal factorization, the faster one, is under the GPL; the simplicial one is not.
#ifdef BELTRAMI_CHOLMOD_SIMPLICIAL
constexpr int kFactorization = CHOLMOD_SIMPLICIAL;
constexpr const char* kName = "cholmod-simplicial";
#else
constexpr int kFactorization = CHOLMOD_AUTO;
constexpr const char* kName = "cholmod";
#endif

class CholmodSolver final : public SpdSolver {
 public:
  CholmodSolver() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.postorder = 1;
    common_.supernodal = kFactorization;
    common_.final_ll = 1;  // L L^T: L D L^T would take an indefinite matrix for a definite one
    common_.quick_return_if_not_posdef = 1;
  }
  ~CholmodSolver() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void analyze(const SparseMatrix& lower, std::span<const Place> /*places*/,
               std::span<const int> /*order*/) override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_sparse view = view_of(lower);
    factor_ = cholmod_analyze(&view, &common_);
    require_success();
  }

  bool factorize(const SparseMatrix& lower) override {
    cholmod_sparse view = view_of(lower);
    cholmod_factorize(&view, factor_, &common_);
    if (common_.status == CHOLMOD_NOT_POSDEF) return false;
    require_success();
    // It takes what is no number for a pivot.
    return factor_->minor == factor_->n && cholmod_rcond(factor_, &common_) > 0;
  }

  DenseMatrix solve(const DenseMatrix& rhs) const override {
    cholmod_dense view{};
    view.nrow = static_cast<std::size_t>(rhs.rows());
    view.ncol = static_cast<std::size_t>(rhs.cols());
    view.nzmax = view.nrow * view.ncol;
    view.d = view.nrow;
    view.x = const_cast<double*>(rhs.data());
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &view, &common_);
    require_success();
    const DenseMatrix result = Eigen::Map<const DenseMatrix>(
        static_cast<const double*>(solution->x), rhs.rows(), rhs.cols());
    cholmod_free_dense(&solution, &common_);
    return result;
  }

  /// The supernodal factor hides its columns.
  DenseMatrix solve_rows(const SparseMatrix& rhs, const std::vector<int>& rows) const override {
    return rows_of_whole_solves(*this, rhs, rows);
  }

 private:
  static cholmod_sparse view_of(const SparseMatrix& lower) {
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(lower.rows());
    view.ncol = static_cast<std::size_t>(lower.cols());
    view.nzmax = static_cast<std::size_t>(lower.nonZeros());
    view.p = const_cast<int*>(lower.outerIndexPtr());
    view.i = const_cast<int*>(lower.innerIndexPtr());
    view.x = const_cast<double*>(lower.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  void require_success() const {
    if (common_.status >= CHOLMOD_OK) return;
    if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    throw Error(Fault::kSolver, "CHOLMOD could not treat the linear system (status " +
                                    std::to_string(common_.status) + ")");
  }

  mutable cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace

std::unique_ptr<SpdSolver> make_spd_solver(const SolverOptions& /*options*/, const Work& /*work*/) {
  return std::make_unique<CholmodSolver>();
}

const char* spd_solver_name() {
  return kName;
}

}  // namespace beltrami
