// Factorizing matrices that are definite in theory and only just so in floating point.
#pragma once

#include "linear/spd_solver.h"

namespace beltrami {

/// Factorizes an analyzed matrix; where it comes out indefinite, again with relative shifts of its
/// diagonal, from 1e-13 up to 1e-6. Returns the shift of the factor, 0 as a rule, or a negative
/// number if none helps. The matrix is left as it was.
[[nodiscard]] double factorize_shifted(SpdSolver& solver, SparseMatrix& lower);

}  // namespace beltrami
