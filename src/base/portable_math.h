// Elementary functions with the same bits on every processor. Those of the C library choose among
// versions with and without fused multiply-add when a program is loaded, which differ in the last
// bit; these are sums, products, quotients and square roots alone, which IEEE 754 rounds one way.
// Whatever reaches a result takes these; of <cmath> it takes what is exact (abs, floor, ldexp,
// remainder, ...) or rounded correctly (sqrt) by its definition.
//
// All need the rounding mode "to nearest" (StandardFloatingPoint).
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace beltrami::portable {

/// Within 1 ulp; 0 and infinity outside of the range of numbers.
double exp(double x);

/// Within 1 ulp. -infinity at 0, NaN below.
double log(double x);

/// Within 1 ulp for |x| <= 1e6; beyond, that of a number within 1 ulp of x. NaN at infinity.
double sin(double x);
double cos(double x);

/// The angle of (x, y) in [-pi, pi], within 2 ulp; signs of zero and infinities as in C.
double atan2(double y, double x);

/// ldexp: as one product where 2^exponent is a normal double, which IEEE 754 rounds alike.
inline double times_power_of_two(double x, int exponent) {
  if (exponent < -1022 || exponent > 1023) return std::ldexp(x, exponent);
  return x * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// hypot where it is not safe to square: `larger` is the larger modulus of x and y.
double hypot_far_from_one(double x, double y, double larger);

/// sqrt(x^2 + y^2) within 1 ulp, over the whole range of numbers.
inline double hypot(double x, double y) {
  const double larger = std::max(std::abs(x), std::abs(y));
  if (larger > 0x1p-500 && larger < 0x1p500) return std::sqrt(x * x + y * y);
  return hypot_far_from_one(x, y, larger);
}

}  // namespace beltrami::portable
