// The number type in which the predicates decide what doubles leave open. Sums, differences and
// products of finite doubles are exact in it, without the change of the rounding mode that CGAL's
// filtered kernels make, which emulated processors do not follow. It is CGAL's, headers alone and
// no GMP, or our own: both have the same signs.
#pragma once

#ifdef BELTRAMI_EXACT_OWN
#include "exact/big_float.h"
#else
#include <CGAL/MP_Float.h>
#endif

namespace beltrami {

#ifdef BELTRAMI_EXACT_OWN

inline constexpr const char* kExactNumberName = "own";
using ExactNumber = BigFloat;

#else

inline constexpr const char* kExactNumberName = "cgal";
using ExactNumber = CGAL::MP_Float;

inline int sign_of(const ExactNumber& x) {
  return static_cast<int>(CGAL::sign(x));
}

#endif

}  // namespace beltrami
