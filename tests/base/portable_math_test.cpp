// The elementary functions beside correctly rounded values, and beside those of the C library.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/portable_math.h"
#include "base/types.h"
#include "support/disks.h"

namespace beltrami {
namespace {

using disks::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Arguments and values, rounded from 400 bits.
struct Row {
  double x, value;
};
struct Row2 {
  double x, y, value;
};
constexpr Row kExp[] = {{0x0.0p+0, 0x1.0000000000000p+0},
                        {-0x0.0p+0, 0x1.0000000000000p+0},
                        {0x1.0000000000000p+0, 0x1.5bf0a8b145769p+1},
                        {-0x1.0000000000000p+0, 0x1.78b56362cef38p-2},
                        {0x1.0000000000000p-1, 0x1.a61298e1e069cp+0},
                        {0x1.70ef54646d497p-57, 0x1.0000000000000p+0},
                        {0x1.0000000000000p-30, 0x1.0000000400000p+0},
                        {-0x1.62e42fefa39efp-2, 0x1.6a09e667f3bcdp-1},
                        {0x1.62e42fefa39efp-2, 0x1.6a09e667f3bccp+0},
                        {0x1.65614e36cdc4cp-2, 0x1.6aeb6de6cf1efp+0},
                        {0x1.5000000000000p+3, 0x1.1bb7015e84d3bp+15},
                        {-0x1.2a00000000000p+5, 0x1.3278bcd70e981p-54},
                        {0x1.9000000000000p+6, 0x1.3494a9b171bf5p+144},
                        {0x1.5e00000000000p+9, 0x1.d945df4f8ec8ep+1009},
                        {0x1.62e3d70a3d70ap+9, 0x1.fe9ce5c4c52b4p+1023},
                        {-0x1.6240000000000p+9, 0x0.e6cf6d08897acp-1022},
                        {-0x1.7200000000000p+9, 0x0.0000000000055p-1022},
                        {0x1.581fef5567df4p+7, 0x1.2cfb5197662f1p+248},
                        {0x1.528074fabe640p+8, 0x1.4762ae6cc8871p+488},
                        {0x1.9d455fb7d404cp+8, 0x1.2b007689e8ef3p+596},
                        {0x1.35b7174221d86p+9, 0x1.917950a637783p+893},
                        {0x1.4fdba6311b050p+8, 0x1.746450fefe458p+484},
                        {0x1.27a0a3afe0e48p+9, 0x1.001d84b73a5d5p+853},
                        {-0x1.49b24359f833dp+9, 0x1.9f2388bc65396p-952},
                        {-0x1.8106b9b1a8740p+5, 0x1.7adf04a9e7a2bp-70}};

constexpr Row kLog[] = {{0x1.0000000000000p+0, 0x0.0p+0},
                        {0x1.0000000000000p+1, 0x1.62e42fefa39efp-1},
                        {0x1.0000000000000p-1, -0x1.62e42fefa39efp-1},
                        {0x1.0000000000001p+0, 0x1.fffffffffffffp-53},
                        {0x1.fffffffffffffp-1, -0x1.0000000000000p-53},
                        {0x1.6a09e667f3bcdp+0, 0x1.62e42fefa39f0p-2},
                        {0x1.6a09e667f3bccp+0, 0x1.62e42fefa39eep-2},
                        {0x1.68c06ffea27e0p-1, -0x1.6689b5505b1e5p-2},
                        {0x1.8000000000000p+1, 0x1.193ea7aad030bp+0},
                        {0x1.4000000000000p+3, 0x1.26bb1bbb55516p+1},
                        {0x1.56e1fc2f8f359p-997, -0x1.5963447f87fb5p+9},
                        {0x1.7e43c8800759cp+996, 0x1.5963447f87fb5p+9},
                        {0x0.0000000000001p-1022, -0x1.74385446d71c3p+9},
                        {0x1.0000000000000p-1022, -0x1.6232bdd7abcd2p+9},
                        {0x1.e2ffa6cff07a8p+428, 0x1.294d44b596e96p+8},
                        {0x1.a8c8279a85a80p-584, -0x1.944aa35b881d4p+8},
                        {0x1.cfb10ebe5bb28p+56, 0x1.3b484331619c9p+5},
                        {0x1.bca4e20fc7d96p-122, -0x1.500c24db106d2p+6},
                        {0x1.1667d2c686bfap+274, 0x1.7c03307025f1cp+7},
                        {0x1.fea11a035b738p+594, 0x1.9c6b7e05c396ep+8},
                        {0x1.bbdcd5687c964p-331, -0x1.c9c3441e8b45dp+7},
                        {0x1.74e415ea959c0p+873, 0x1.2ebf2e31a63acp+9}};

constexpr Row kSin[] = {{0x0.0p+0, 0x0.0p+0},
                        {0x1.56e1fc2f8f359p-997, 0x1.56e1fc2f8f359p-997},
                        {0x1.0000000000000p-27, 0x1.0000000000000p-27},
                        {0x1.0000000000000p-1, 0x1.eaee8744b05f0p-2},
                        {0x1.84a3b9cc1c4dfp-1, 0x1.60611f0b2fbddp-1},
                        {0x1.921fb54442d18p-1, 0x1.6a09e667f3bccp-1},
                        {0x1.0000000000000p+0, 0x1.aed548f090ceep-1},
                        {-0x1.0000000000000p+0, -0x1.aed548f090ceep-1},
                        {0x1.8000000000000p+1, 0x1.210386db6d55bp-3},
                        {0x1.921fb54442d18p+0, 0x1.0000000000000p+0},
                        {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
                        {0x1.2d97c7f3321d2p+2, -0x1.0000000000000p+0},
                        {0x1.5fdbbe9bba775p+3, -0x1.0000000000000p+0},
                        {-0x1.f6a7a2955385ep+2, -0x1.0000000000000p+0},
                        {0x1.7f7ef77e83f1ap+19, 0x1.0000000000000p+0},
                        {0x1.d231c457fe767p+19, -0x1.0000000000000p+0},
                        {0x1.6300000000000p+8, -0x1.f9bd0307d1de3p-16},
                        {0x1.86a0000000000p+16, 0x1.24daa9c527e96p-5},
                        {-0x1.e848000000000p+19, 0x1.6664b2568d867p-2},
                        {0x1.e847f00000000p+19, -0x1.833357b1489f3p-1},
                        {0x1.4c2824ff597e0p+12, -0x1.c0131ff5dcf77p-1},
                        {-0x1.a97ea6ec72fbcp+12, 0x1.59968b441b514p-4},
                        {0x1.736f0989bd450p+12, -0x1.a18010a0642a4p-1},
                        {-0x1.c38a6d15b2f3ep+12, 0x1.b1fa62dac4980p-1},
                        {0x1.25a19cf402dacp+11, -0x1.84507c5b1adcdp-1},
                        {-0x1.d2a03ede965dcp+12, -0x1.ffe4b4f02fa33p-1}};

constexpr Row kCos[] = {{0x0.0p+0, 0x1.0000000000000p+0},
                        {0x1.56e1fc2f8f359p-997, 0x1.0000000000000p+0},
                        {0x1.0000000000000p-27, 0x1.0000000000000p+0},
                        {0x1.0000000000000p-1, 0x1.c1528065b7d50p-1},
                        {0x1.84a3b9cc1c4dfp-1, 0x1.737265a9bec39p-1},
                        {0x1.921fb54442d18p-1, 0x1.6a09e667f3bcdp-1},
                        {0x1.0000000000000p+0, 0x1.14a280fb5068cp-1},
                        {-0x1.0000000000000p+0, 0x1.14a280fb5068cp-1},
                        {0x1.8000000000000p+1, -0x1.fae04be85e5d2p-1},
                        {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
                        {0x1.921fb54442d18p+1, -0x1.0000000000000p+0},
                        {0x1.2d97c7f3321d2p+2, -0x1.a79394c9e8a0ap-53},
                        {0x1.5fdbbe9bba775p+3, -0x1.ee2c2d963a10cp-52},
                        {-0x1.f6a7a2955385ep+2, 0x1.60fafbfd97309p-52},
                        {0x1.7f7ef77e83f1ap+19, 0x1.599fad35cf60bp-43},
                        {0x1.d231c457fe767p+19, -0x1.0928e20de242cp-36},
                        {0x1.6300000000000p+8, -0x1.fffffffc18e4cp-1},
                        {0x1.86a0000000000p+16, -0x1.ffac3841b3da7p-1},
                        {-0x1.e848000000000p+19, 0x1.df9df9906d32cp-1},
                        {0x1.e847f00000000p+19, 0x1.4efdfc640fc4dp-1},
                        {0x1.4c2824ff597e0p+12, 0x1.ef78c2f0e211fp-2},
                        {-0x1.a97ea6ec72fbcp+12, -0x1.fe2ca395877abp-1},
                        {0x1.736f0989bd450p+12, 0x1.285fbd63c6f05p-1},
                        {-0x1.c38a6d15b2f3ep+12, 0x1.0facac09058fap-1},
                        {0x1.25a19cf402dacp+11, 0x1.4db34aa323df3p-1},
                        {-0x1.d2a03ede965dcp+12, -0x1.4e5651567c688p-6}};

constexpr Row2 kAtan2[] = {{0x0.0p+0, 0x1.0000000000000p+0, 0x0.0p+0},
                           {0x1.0000000000000p+0, 0x1.0000000000000p+0, 0x1.921fb54442d18p-1},
                           {0x1.0000000000000p+0, 0x0.0p+0, 0x1.921fb54442d18p+0},
                           {0x1.0000000000000p+0, -0x1.0000000000000p+0, 0x1.2d97c7f3321d2p+1},
                           {-0x1.0000000000000p+0, -0x1.0000000000000p+0, -0x1.2d97c7f3321d2p+1},
                           {-0x1.0000000000000p+0, 0x1.0000000000000p+0, -0x1.921fb54442d18p-1},
                           {0x1.00477a25df6c4p-4, 0x1.0000000000000p+0, 0x1.ffe421310aa37p-5},
                           {0x1.0c17c9ad7e480p-4, 0x1.e81d12e86add0p-1, 0x1.18c59382945c2p-4},
                           {0x1.b7cdfd9d7bdbbp-34, 0x1.0000000000000p+0, 0x1.b7cdfd9d7bdbbp-34},
                           {0x1.b7cdfd9d7bdbbp-34, -0x1.0000000000000p+0, 0x1.921fb5440bd7cp+1},
                           {0x1.0000000000000p+0, 0x1.b7cdfd9d7bdbbp-34, 0x1.921fb543d4de0p+0},
                           {0x1.0000000000000p+0, -0x1.b7cdfd9d7bdbbp-34, 0x1.921fb544b0c50p+0},
                           {0x0.03739a252b281p-1022, 0x0.3986b3c0cf469p-1022, 0x1.eaee734b5dd0ap-5},
                           {0x1.1ccf385ebc8a0p+1023, 0x1.ab36d48e1acf0p+1023, 0x1.2d0ead6066395p-1},
                           {0x0.0000000000001p-1022, 0x1.7e43c8800759cp+996, 0x0.0p+0},
                           {-0x1.fe2ebb038a73cp-1, 0x1.7c518680ae19cp-1, -0x1.dc447a88bfa6ap-1},
                           {-0x1.2984441cfae1cp-1, -0x1.2358e7851a8e4p-1, -0x1.2c407dcc6d74cp+1},
                           {0x1.edffcc953ac8ap-1, 0x1.7d5876154f5d0p-1, 0x1.d3a7fab49df78p-1},
                           {-0x1.af80c5afb48b8p-2, 0x1.d88daf9975348p-1, -0x1.b6945362ebf8dp-2},
                           {0x1.4151938125520p-4, 0x1.6c3262a02fda8p-2, 0x1.bc9a0df76b398p-3},
                           {-0x1.2e4e4768bf14ep-1, 0x1.c38f367bf9ab0p-1, -0x1.2e0cc95fbba44p-1},
                           {0x1.866f483266aa0p-2, 0x1.ddc308fb88474p-1, 0x1.8d36f9aa7e065p-2},
                           {0x1.933104b10d77ap-1, -0x1.9c1490fa7a600p-2, 0x1.058858f968d2cp+1},
                           {-0x1.1c487395c8ac8p-2, -0x1.560f9d8837f24p-1, -0x1.5fb68aa7e3836p+1},
                           {-0x1.6acd1e5e3b692p-1, -0x1.bd4c03d585caep-1, -0x1.3a9d64d1399b2p+1}};

constexpr Row2 kHypot[] = {
    {0x0.0p+0, 0x0.0p+0, 0x0.0p+0},
    {0x1.8000000000000p+1, 0x1.0000000000000p+2, 0x1.4000000000000p+2},
    {-0x1.8000000000000p+1, 0x1.0000000000000p+2, 0x1.4000000000000p+2},
    {0x1.4e718d7d7625ap+664, 0x1.4e718d7d7625ap+664, 0x1.d8f9811335b57p+664},
    {0x1.87e92154ef7acp-665, 0x1.87e92154ef7acp-665, 0x1.151f68876f410p-664},
    {0x0.0000000000001p-1022, 0x0.0000000000001p-1022, 0x0.0000000000001p-1022},
    {0x0.00000000017b8p-1022, 0x0.0000000001fa0p-1022, 0x0.0000000002788p-1022},
    {0x1.2833ab43ce521p+1020, 0x1.c7b1f3cac7433p+1023, 0x1.c932619b953e4p+1023},
    {0x1.7e43c8800759cp+996, 0x1.56e1fc2f8f359p-997, 0x1.7e43c8800759cp+996},
    {0x1.0000000000000p+500, 0x1.0000000000000p-500, 0x1.0000000000000p+500},
    {0x1.71186b97f3abcp-1, 0x1.05a7e3df105a6p-1, 0x1.c46eb905e46a0p-1},
    {-0x1.96d10a2ebeda8p-2, 0x1.a656ab2c1ab50p-3, 0x1.ca5bae8dd93a0p-2},
    {-0x1.fc8922b3b6f64p-1, 0x1.6c68cab52a438p-2, 0x1.0e188a07362bbp+0},
    {-0x1.4bfcbaef19274p-2, -0x1.8534c6a507b1cp-2, 0x1.ff9030a90ee0ep-2},
    {0x1.46299a272d1d0p-1, -0x1.3b788a6dbb740p-5, 0x1.46c20722fe188p-1},
    {-0x1.794176d0b2b38p-2, -0x1.33b7cc383dd20p-5, 0x1.7b362967f4d1cp-2},
    {0x1.a329922d16348p-2, -0x1.c5a18c5f356f2p-1, 0x1.f3b48fb21cb10p-1}};

/// Doubles from a to b, both finite and of one sign; a large number otherwise.
std::int64_t ulps_between(double a, double b) {
  if (a == b) return 0;
  if (std::signbit(a) != std::signbit(b)) return std::numeric_limits<std::int64_t>::max();
  return std::abs(std::bit_cast<std::int64_t>(a) - std::bit_cast<std::int64_t>(b));
}

TEST(PortableMath, IsWithinOneUlpOfTheRoundedValue) {
  for (const auto& [x, value] : kExp) EXPECT_LE(ulps_between(portable::exp(x), value), 1) << x;
  for (const auto& [x, value] : kLog) EXPECT_LE(ulps_between(portable::log(x), value), 1) << x;
  for (const auto& [x, value] : kSin) EXPECT_LE(ulps_between(portable::sin(x), value), 1) << x;
  for (const auto& [x, value] : kCos) EXPECT_LE(ulps_between(portable::cos(x), value), 1) << x;
  for (const auto& [x, y, value] : kHypot) {
    EXPECT_LE(ulps_between(portable::hypot(x, y), value), 1) << x << ", " << y;
  }
  for (const auto& [y, x, value] : kAtan2) {
    EXPECT_LE(ulps_between(portable::atan2(y, x), value), 2) << y << ", " << x;
  }
}

// Of any C library's 1 ulp, and 2 of ours.
TEST(PortableMath, AgreesWithTheLibrary) {
  constexpr std::int64_t kMost = 3;
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const double small = random.between(-1, 1), large = random.between(-700, 700);
    for (const double x : {small, large}) {
      EXPECT_LE(ulps_between(portable::exp(x), std::exp(x)), kMost) << x;
      EXPECT_LE(ulps_between(portable::log(std::abs(x)), std::log(std::abs(x))), kMost) << x;
      EXPECT_LE(ulps_between(portable::sin(x), std::sin(x)), kMost) << x;
      EXPECT_LE(ulps_between(portable::cos(x), std::cos(x)), kMost) << x;
    }
    const double x = std::ldexp(small, random.below(1800) - 900), y = x * random.between(-2, 2);
    EXPECT_LE(ulps_between(portable::atan2(y, x), std::atan2(y, x)), kMost) << y << ", " << x;
    EXPECT_LE(ulps_between(portable::hypot(x, y), std::hypot(x, y)), kMost) << x << ", " << y;
  }
}

TEST(PortableMath, EndsWhereTheNumbersDo) {
  EXPECT_EQ(portable::exp(kInfinity), kInfinity);
  EXPECT_EQ(portable::exp(710.0), kInfinity);
  EXPECT_EQ(portable::exp(709.8), kInfinity);
  EXPECT_EQ(portable::exp(-kInfinity), 0);
  EXPECT_EQ(portable::exp(-746.0), 0);
  EXPECT_EQ(portable::log(0), -kInfinity);
  EXPECT_EQ(portable::log(kInfinity), kInfinity);
  EXPECT_EQ(portable::hypot(kInfinity, kNaN), kInfinity);
  EXPECT_EQ(portable::hypot(1.7e308, 1.7e308), kInfinity);
  for (const double x :
       {portable::exp(kNaN), portable::log(kNaN), portable::log(-1), portable::sin(kInfinity),
        portable::cos(kNaN), portable::atan2(kNaN, 1), portable::atan2(1, kNaN),
        portable::hypot(1, kNaN), portable::hypot(kNaN, 1)}) {
    EXPECT_TRUE(std::isnan(x));
  }
}

TEST(PortableMath, KeepsTheSignsOfZeroAndTheQuadrantsOfInfinity) {
  EXPECT_TRUE(std::signbit(portable::sin(-0.0)));
  EXPECT_FALSE(std::signbit(portable::sin(0.0)));
  for (const double y : {0.0, -0.0, 2.0, -2.0, kInfinity, -kInfinity}) {
    for (const double x : {0.0, -0.0, 2.0, -2.0, kInfinity, -kInfinity}) {
      const double angle = portable::atan2(y, x);
      EXPECT_EQ(angle, std::atan2(y, x)) << y << ", " << x;
      EXPECT_EQ(std::signbit(angle), std::signbit(y)) << y << ", " << x;
    }
  }
}

// Beyond 1e6: the sine of a number within 1 ulp of the argument.
TEST(PortableMath, TakesAnyAngle) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const double x = random.between(1e6, 1e12), ulp = std::nextafter(x, kInfinity) - x;
    EXPECT_NEAR(portable::sin(x), std::sin(x), ulp) << x;
    EXPECT_NEAR(portable::cos(x), std::cos(x), ulp) << x;
  }
  for (const double x : {1e22, 1.7e308, -1e300}) {
    const double s = portable::sin(x), c = portable::cos(x);
    EXPECT_NEAR(s * s + c * c, 1, 1e-15) << x;
  }
}

TEST(PortableMath, TimesAPowerOfTwoIsLdexp) {
  for (const double x : {0.0, -0.0, 1.0, -1.5, 0x1.fffffffffffffp1023, 0x1p-1074, 0x1.8p-1000,
                         0x1.123456789abcdp-30, -kInfinity}) {
    for (const int exponent : {-3000, -1100, -1074, -1023, -1022, -50, 0, 50, 1023, 1024, 3000}) {
      const double product = portable::times_power_of_two(x, exponent);
      EXPECT_EQ(product, std::ldexp(x, exponent)) << x << " " << exponent;
      EXPECT_EQ(std::signbit(product), std::signbit(x)) << x << " " << exponent;
    }
  }
}

TEST(PortableMath, DividesComplexNumbers) {
  EXPECT_EQ(quotient(Complex(1, 2), Complex(3, -1)), Complex(0.1, 0.7));
  EXPECT_EQ(quotient(Complex(0, 4), Complex(0, 2)), Complex(2, 0));
}

// Else the order of the sums in its products would follow the processor's caches.
TEST(PortableMath, EigenDoesNotAskForTheCaches) {
  EXPECT_EQ(Eigen::l1CacheSize(), 32 << 10);
  EXPECT_EQ(Eigen::l2CacheSize(), 256 << 10);
  EXPECT_EQ(Eigen::l3CacheSize(), 2 << 20);
}

}  // namespace
}  // namespace beltrami
