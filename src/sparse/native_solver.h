// The solver of this library's own, which is there whatever back end the library is built with.
#pragma once

#include <memory>

#include "sparse/spd_solver.h"

namespace beltrami {

/// A multifrontal Cholesky factorization. Small matrices are ordered by minimum degree, large ones
/// by nested dissection where their places are known and make it the better order.
std::unique_ptr<SpdSolver> make_native_solver(const SolverOptions& options = {});

}  // namespace beltrami
