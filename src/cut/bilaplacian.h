// The operator of thin plates on a mesh, by linear elements.
#pragma once

#include <Eigen/Core>

#include "linear/spd_solver.h"

namespace beltrami {

/// L M^-1 L, (n, n), with L the symmetric `laplacian` and `softness`, (n), the diagonal of M^-1. A
/// hub would make the rows of all vertices around it dense: for it, the square of its sum of
/// differences is replaced by the sum of their squares, which is the same where all around is
/// symmetric, and stiffer elsewhere. Throws std::bad_alloc.
SparseMatrix bilaplacian(const SparseMatrix& laplacian, const Eigen::VectorXd& softness);

}  // namespace beltrami
