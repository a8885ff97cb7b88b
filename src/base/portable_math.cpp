#include "base/portable_math.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace beltrami::portable {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = std::numbers::pi, kPiTail = 0x1.1a62633145c07p-53;
constexpr int kMantissaBits = 52, kBias = 1023;

// ln 2 and pi / 2 in parts: whole multiples of the short ones are exact, up to 2^11 and 2^20.
constexpr double kLn2 = 0x1.62e42fefa3800p-1, kLn2Tail = 0x1.ef35793c76730p-45;
constexpr std::array<double, 4> kHalfPi = {0x1.921fb54400000p+0, 0x1.0b4611a600000p-34,
                                           0x1.3198a2e000000p-69, 0x1.b839a252049c1p-104};

/// The nearest whole number, for |x| < 2^51.
double nearest(double x) {
  constexpr double kShift = 0x1.8p52;
  return (x + kShift) - kShift;
}

/// 2^n for normal numbers.
double power_of_two(int n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + kBias) << kMantissaBits);
}

/// c[0] + x c[1] + x^2 c[2] + ...
template <std::size_t kCount>
double polynomial(const std::array<double, kCount>& c, double x) {
  double sum = c[kCount - 1];
  for (std::size_t i = kCount - 1; i-- > 0;) sum = c[i] + x * sum;
  return sum;
}

/// A number as the sum of two, the second one within the roundoff of the first.
struct Pair {
  double value, tail;
};

Pair sum_of(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// x = quarter * pi / 2 + angle, |angle| <= pi / 4.
struct Reduced {
  int quarter;
  Pair angle;
};

Reduced reduce(double x) {
  constexpr double kFar = 0x1p20;
  if (!(std::abs(x) < kFar)) x = std::remainder(x, 2 * kPi);
  const double n = nearest(x * (1 / (0.5 * kPi)));
  // All exact but the last product.
  const Pair high = sum_of(x - n * kHalfPi[0], -n * kHalfPi[1]);
  const Pair low = sum_of(high.value, -n * kHalfPi[2]);
  return {static_cast<int>(n) & 3, sum_of(low.value, low.tail + (high.tail - n * kHalfPi[3]))};
}

/// Taylor series, as for the other functions: to 2^-58 on [-pi / 4, pi / 4].
double sin_of_reduced(const Pair& angle) {
  constexpr std::array<double, 8> kTerms = {
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  const double x = angle.value, z = x * x;
  return x + (x * z * polynomial(kTerms, z) + angle.tail * (1 - 0.5 * z));
}

double cos_of_reduced(const Pair& angle) {
  constexpr std::array<double, 8> kTerms = {
      1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
      1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
  const double x = angle.value, z = x * x, half = 0.5 * z, top = 1 - half;
  return top + (((1 - top) - half) + (z * z * polynomial(kTerms, z) - x * angle.tail));
}

/// The arc tangent for 0 <= q <= 1, by the distance to the nearest eighth.
Pair atan_up_to_one(double q) {
  constexpr std::array<Pair, 9> kOfEighths = {{{0, 0},
                                               {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                               {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                               {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                               {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                               {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                               {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                               {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                               {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
  constexpr std::array<double, 7> kTerms = {-1.0 / 3,  1.0 / 5,  -1.0 / 7, 1.0 / 9,
                                            -1.0 / 11, 1.0 / 13, -1.0 / 15};
  const auto eighths = static_cast<std::size_t>(8 * q + 0.5);
  const double near = static_cast<double>(eighths) / 8;
  const double u = (q - near) / (1 + q * near), z = u * u;
  return {kOfEighths[eighths].value,
          u + (u * z * polynomial(kTerms, z) + kOfEighths[eighths].tail)};
}

}  // namespace

double exp(double x) {
  if (!(x < 710)) return x > 0 ? kInfinity : x;
  if (x < -746) return 0;
  constexpr std::array<double, 12> kTerms = {
      1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,      1.0 / 720,       1.0 / 5040,
      1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  const double n = nearest(x * std::numbers::log2e);
  const double high = x - n * kLn2, low = n * kLn2Tail, r = high - low;
  const double y = 1 + (high + (r * r * polynomial(kTerms, r) - low));
  // Two factors: each is a normal number, and only the second product is rounded.
  const int exponent = static_cast<int>(n), half = exponent / 2;
  return y * power_of_two(half) * power_of_two(exponent - half);
}

double log(double x) {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNaN;
  if (x == kInfinity) return x;
  int exponent = 0;
  if (x < std::numeric_limits<double>::min()) {
    constexpr int kUp = 54;
    x *= power_of_two(kUp);
    exponent = -kUp;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> kMantissaBits) - kBias;
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << kMantissaBits) - 1;
  double m = std::bit_cast<double>((bits & kMantissa) | std::bit_cast<std::uint64_t>(1.0));
  if (m > std::numbers::sqrt2) {
    m *= 0.5;
    ++exponent;
  }
  // log(1 + f) = 2 artanh(s) with s = f / (2 + f), and 2 s = f - f^2 / 2 + s f^2 / 2.
  constexpr std::array<double, 11> kTerms = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,
                                             2.0 / 11, 2.0 / 13, 2.0 / 15, 2.0 / 17,
                                             2.0 / 19, 2.0 / 21, 2.0 / 23};
  const double f = m - 1, s = f / (2 + f), z = s * s, half = 0.5 * f * f;
  const double rest = s * (half + z * polynomial(kTerms, z));
  const auto k = static_cast<double>(exponent);
  return k * kLn2 - ((half - (rest + k * kLn2Tail)) - f);
}

double sin(double x) {
  if (std::abs(x) < 0x1p-27) return x;  // and keeps the sign of zero
  const auto [quarter, angle] = reduce(x);
  const double value = quarter % 2 == 0 ? sin_of_reduced(angle) : cos_of_reduced(angle);
  return quarter < 2 ? value : -value;
}

double cos(double x) {
  const auto [quarter, angle] = reduce(x);
  const double value = quarter % 2 == 0 ? cos_of_reduced(angle) : sin_of_reduced(angle);
  return quarter == 0 || quarter == 3 ? value : -value;
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return kNaN;
  double low = std::abs(y), high = std::abs(x);
  const bool steep = low > high;
  if (steep) std::swap(low, high);
  // Equal where both are zero or infinite.
  const Pair flat = atan_up_to_one(low == high ? (high > 0 ? 1.0 : 0.0) : low / high);
  const double angle = flat.value + flat.tail;
  double result = angle;
  if (steep) {
    const Pair rest = sum_of(0.5 * kPi, std::signbit(x) ? flat.value : -flat.value);
    const double tail = std::signbit(x) ? flat.tail : -flat.tail;
    result = rest.value + (rest.tail + (tail + 0.5 * kPiTail));
  } else if (std::signbit(x)) {
    const Pair rest = sum_of(kPi, -flat.value);
    result = rest.value + (rest.tail + (kPiTail - flat.tail));
  }
  return std::copysign(result, y);
}

double hypot_far_from_one(double x, double y, double larger) {
  if (std::isinf(x) || std::isinf(y)) return kInfinity;
  constexpr int kShift = 600;
  const int shift = larger < 1 ? kShift : -kShift;
  x *= power_of_two(shift);
  y *= power_of_two(shift);
  return std::sqrt(x * x + y * y) * power_of_two(-shift);
}

}  // namespace beltrami::portable
