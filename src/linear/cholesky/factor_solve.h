// Solves with a multifrontal Cholesky factor.
#pragma once

#include <functional>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/front.h"
#include "linear/cholesky/symbolic.h"
#include "linear/spd_solver.h"

namespace beltrami {

/// x = A^-1 x for `columns` right-hand sides, one after the other, in the order of L. `factor`: the
/// panels of the supernodes, at symbolic.value_start. The same bits at any number of threads.
template <class T>
void solve_with_factor(front::Vectors vectors, const Symbolic& symbolic, const T* factor, T* x,
                       int columns, const Work& work);

/// What a solve asks for the panel of a supernode, which it needs no longer than until it asks for
/// the next one in the same space: above the diagonal is whatever.
template <class T>
using PanelOf = std::function<const T*(int supernode, std::vector<T>& space)>;

/// The same with panels that are made when they are needed.
template <class T>
void solve_with_panels(front::Vectors vectors, const Symbolic& symbolic, const PanelOf<T>& panel_of,
                       T* x, int columns, const Work& work);

/// rows(A^-1 rhs), in the order of the matrix, like SpdSolver::solve_rows. Only the supernodes
/// that right-hand sides or wanted rows reach are visited.
template <class T>
DenseMatrix solve_rows_with_factor(front::Vectors vectors, const Symbolic& symbolic,
                                   const T* factor, const SparseMatrix& rhs,
                                   const std::vector<int>& rows, const Work& work);

}  // namespace beltrami
