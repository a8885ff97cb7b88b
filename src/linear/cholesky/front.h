// Dense kernels of the multifrontal factorization and of the solves with its factor. They use the
// widest vectors of the machine they run on, yet each number comes from the same operations in the
// same order with any width (no fused multiply-add), so the bits do not depend on the machine.
#pragma once

#include <cstdint>
#include <functional>

#include "base/work.h"

namespace beltrami::front {

/// Rows of a packed group. Leading dimensions of update matrices are multiples of it.
inline constexpr int kGroup = 8;
inline int padded(int rows) {
  return (rows + kGroup - 1) / kGroup * kGroup;
}

/// Columns that are eliminated together before the rest of the front is updated.
inline constexpr int kOuterBlock = 128;
/// Scalars of buffer that factorize() needs.
inline std::int64_t buffer_size(int height, int width) {
  return static_cast<std::int64_t>(padded(height)) * (width < kOuterBlock ? width : kOuterBlock);
}

/// The vectors that the kernels use.
enum class Vectors { kBaseline, kAvx2 };
/// The widest of the machine that the run is on.
inline Vectors widest_vectors(const Work& work) {
  return work.on_avx2() ? Vectors::kAvx2 : Vectors::kBaseline;
}

/// Calls body(begin, end) over [0, count) in chunks, maybe side by side.
using ForChunks = std::function<void(int count, const std::function<void(int, int)>& body)>;

/// Eliminates the first `width` columns of a symmetric front of `height` rows. `panel`: those
/// columns, contiguous. `update`: the lower triangle of the rest, with a leading dimension of
/// padded(height - width); becomes the Schur complement. Above the diagonals anything may be
/// written. False: a pivot is not positive (or NaN). `for_chunks` may be empty.
template <class T>
bool factorize(Vectors vectors, T* panel, int height, int width, T* update, T* buffer,
               const ForChunks& for_chunks);

/// y -= L x for the rows below the diagonal block and x = L1^-1 x, where L1 is the diagonal block
/// of a panel: `x` has `height` entries per right-hand side, one after the other, `x` first, then
/// y.
template <class T>
void solve_forward(Vectors vectors, const T* panel, int height, int width, T* x, int columns);
/// x = L1^-T (x - L^T y).
template <class T>
void solve_backward(Vectors vectors, const T* panel, int height, int width, T* x, int columns);

/// The same for `columns` right-hand sides, 4, 8 or 16, whose entries in one row lie side by side:
/// rows[i] has those of row i of the panel. No entry depends on how many there are beside it.
template <class T>
void solve_forward_side_by_side(Vectors vectors, const T* panel, int height, int width,
                                T* const* rows, int columns);
template <class T>
void solve_backward_side_by_side(Vectors vectors, const T* panel, int height, int width,
                                 T* const* rows, int columns);

}  // namespace beltrami::front
