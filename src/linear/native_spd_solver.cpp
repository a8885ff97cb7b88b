#include "base/work.h"
#include "linear/cholesky/native_solver.h"
#include "linear/spd_solver.h"

namespace beltrami {

std::unique_ptr<SpdSolver> make_spd_solver(const SolverOptions& options, const Work& work) {
  return make_native_solver(options, kLeastSingle, work);
}

const char* spd_solver_name() {
  return "native";
}

}  // namespace beltrami
