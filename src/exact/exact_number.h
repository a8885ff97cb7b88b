// The number type in which the predicates decide what doubles leave open. Sums, differences and
// products of finite doubles are exact in it, without the change of the rounding mode that CGAL's
// filtered kernels make, which emulated processors do not follow. It is headers alone: no GMP.
#pragma once

#include <CGAL/MP_Float.h>

namespace beltrami {

using ExactNumber = CGAL::MP_Float;

inline int sign_of(const ExactNumber& x) {
  return static_cast<int>(CGAL::sign(x));
}

}  // namespace beltrami
