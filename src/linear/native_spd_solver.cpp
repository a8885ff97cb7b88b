#include "linear/cholesky/native_solver.h"
#include "linear/spd_solver.h"

namespace beltrami {

std::unique_ptr<SpdSolver> make_spd_solver(const SolverOptions& options) {
  return make_native_solver(options);
}

const char* spd_solver_name() {
  return "native";
}

}  // namespace beltrami
