// The number type in which the predicates decide what doubles leave open. Sums, differences and
// products of doubles are exact in it, without the change of the rounding mode that CGAL's filtered
// kernels make, which emulated processors do not follow.
#pragma once

#include <CGAL/Mpzf.h>
#ifndef CGAL_HAS_MPZF
#include <CGAL/Exact_rational.h>
#endif

namespace beltrami {

#ifdef CGAL_HAS_MPZF
using ExactNumber = CGAL::Mpzf;
#else
using ExactNumber = CGAL::Exact_rational;
#endif

inline int sign_of(const ExactNumber& x) {
  return static_cast<int>(CGAL::sign(x));
}

}  // namespace beltrami
