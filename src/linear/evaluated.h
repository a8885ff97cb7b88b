// Sparse matrices from expressions and copies, without a leak where memory ends.
#pragma once

#include "linear/spd_solver.h"

namespace beltrami {

/// The matrix that an expression, or another matrix, stands for. Constructors of Eigen's sparse
/// matrices that run out of memory halfway leave some behind; an assignment does not.
template <class Expression>
SparseMatrix evaluated(const Expression& expression) {
  SparseMatrix matrix;
  matrix = expression;
  return matrix;
}

}  // namespace beltrami
