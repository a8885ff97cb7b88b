// Our own exact numbers beside CGAL's.
#include "exact/big_float.h"

#include <CGAL/MP_Float.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace beltrami {
namespace {

constexpr double kLeast = std::numeric_limits<double>::denorm_min();
constexpr double kGreatest = std::numeric_limits<double>::max();

int sign_of_cgal(const CGAL::MP_Float& x) {
  return static_cast<int>(CGAL::sign(x));
}

/// Doubles of every kind: of all exponents, subnormal, near each other, small whole ones, zero.
class Doubles {
 public:
  double next() {
    const auto kind = generator_() % 6;
    if (kind == 0) return static_cast<double>(static_cast<std::int64_t>(generator_() % 17) - 8);
    if (kind == 1) return std::ldexp(unit(), -1040 - static_cast<int>(generator_() % 40));
    if (kind == 2) return std::ldexp(unit(), 900 + static_cast<int>(generator_() % 124));
    if (kind == 3) return std::ldexp(unit(), static_cast<int>(generator_() % 2000) - 1000);
    if (kind == 4) return 1 + std::ldexp(unit(), -static_cast<int>(generator_() % 60));
    return unit();
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }

  std::mt19937_64 generator_{20261127};
};

/// The predicates' expressions, and one that is zero unless the order of sums counts.
template <class Number>
Number expression(std::size_t which, const std::vector<double>& x) {
  const Number a(x[0]), b(x[1]), c(x[2]), d(x[3]), e(x[4]), f(x[5]);
  if (which == 0) return (a - e) * (d - f) - (b - f) * (c - e);
  if (which == 1) return (a * a + b * b) * (c * d - e * f);
  if (which == 2) return (a + b + c) - (c + b + a);
  return a * b - c * d + e - f;
}

TEST(BigFloat, HasTheSignsOfCgalsNumbersInAMillionRandomExpressions) {
  constexpr int kExpressions = 1'000'000;
  Doubles doubles;
  int differing = 0, zeros = 0;
  std::vector<double> x(6);
  for (int i = 0; i < kExpressions; ++i) {
    for (double& value : x) value = doubles.next();
    const std::size_t which = static_cast<std::size_t>(i) % 4;
    // Every other one is of products that are alike, whose difference may be nothing at all.
    if (i % 8 >= 4) x = {x[0], x[1], x[0], i % 3 == 0 ? x[1] : std::nextafter(x[1], 0), x[2], x[2]};
    const int ours = expression<BigFloat>(which, x).sign();
    const int theirs = sign_of_cgal(expression<CGAL::MP_Float>(which, x));
    differing += ours != theirs ? 1 : 0;
    zeros += theirs == 0 ? 1 : 0;
  }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(zeros, kExpressions / 100);
}

TEST(BigFloat, LosesNothingAtTheEndsOfTheRange) {
  const BigFloat least(kLeast), greatest(kGreatest), one(1);
  EXPECT_EQ((least * least).sign(), 1);  // 0 in doubles
  EXPECT_EQ((greatest * greatest - greatest).sign(), 1);
  EXPECT_EQ((greatest + least - greatest - least).sign(), 0);
  EXPECT_EQ((greatest + least - greatest).sign(), 1);
  EXPECT_EQ((one + least * least - one - least * least).sign(), 0);
  EXPECT_EQ((least * greatest * greatest * least - least * greatest * least * greatest).sign(), 0);
}

TEST(BigFloat, ZeroIsZeroOfEitherSign) {
  for (const double zero : {0.0, -0.0}) {
    const BigFloat nothing(zero), something(-3.5);
    EXPECT_EQ(nothing.sign(), 0);
    EXPECT_EQ((nothing * something).sign(), 0);
    EXPECT_EQ((nothing - something).sign(), 1);
    EXPECT_EQ((something + nothing).sign(), -1);
    EXPECT_EQ((something - something).sign(), 0);
  }
}

TEST(BigFloat, CarriesAndBorrowsThroughAllDigits) {
  const BigFloat big(0x1p96), one(1), small(0x1p-64);
  EXPECT_EQ(((big - one) + one - big).sign(), 0);
  EXPECT_EQ(((big - small) - (big - one)).sign(), 1);
  EXPECT_EQ(((big - small) * (big + small) - (big * big - small * small)).sign(), 0);
}

}  // namespace
}  // namespace beltrami
