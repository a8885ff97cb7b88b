// A Cholesky factor in 16 bits per entry, for preconditioning.
#pragma once

#include <cstdint>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/front.h"
#include "linear/cholesky/symbolic.h"

namespace beltrami {

/// L of a matrix whose diagonal is near 1, rounded: what is below the diagonal to 2^-16 of the
/// largest of its column, so that L L^T is still definite. Of a vector x that A takes to next to
/// nothing, L^T x is next to nothing, too: what rounding adds to |L^T x|^2, its share in L L^T, is
/// of the size of its square.
class CompactFactor {
 public:
  CompactFactor() = default;
  /// `panels`: of the supernodes, at symbolic.value_start.
  CompactFactor(const Symbolic& symbolic, const float* panels, const Work& work);

  bool empty() const { return start_.empty(); }

  /// x = (L L^T)^-1 x for `columns` right-hand sides, one after the other, in the order of L. The
  /// same bits at any number of threads.
  void solve(front::Vectors vectors, const Symbolic& symbolic, float* x, int columns,
             const Work& work) const;

 private:
  void unpack(const Symbolic& symbolic, int s, float* panel) const;

  std::vector<std::int64_t> start_;     ///< per supernode, and one more: entries before its own
  std::vector<std::int16_t> entries_;   ///< below the diagonal, column after column
  std::vector<float> diagonal_, unit_;  ///< per column of scalars; `unit_`: of its entries
};

}  // namespace beltrami
