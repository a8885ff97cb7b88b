// The solver of this library's own, which is there whatever back end the library is built with.
#pragma once

#include <memory>

#include "base/work.h"
#include "linear/spd_solver.h"

namespace beltrami {

/// Below so many vertices minimum degree takes no more time than nested dissection saves, and ends
/// before a cancel, which it does not hear, has to wait for long.
inline constexpr int kLeastDissected = 60000;
/// Below so many rows factors in double precision stay in the caches.
inline constexpr int kLeastSingle = 50000;

/// A multifrontal Cholesky factorization. Small matrices are ordered by minimum degree, large ones
/// by nested dissection where their places are known and make it the better order.
/// Smaller matrices than `least_single` are factorized in double precision whatever the options
/// say: iterating would cost more than it saves.
std::unique_ptr<SpdSolver> make_native_solver(const SolverOptions& options, int least_single,
                                              const Work& work);

}  // namespace beltrami
