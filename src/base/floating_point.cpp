#include "base/floating_point.h"

#include <cfenv>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace beltrami {
namespace {

#if defined(__SSE2__) || defined(_M_X64)
constexpr unsigned kDefaultMxcsr = 0x1f80;  // all exceptions masked, nearest, no FTZ, no DAZ
unsigned long long read_mode() {
  return _mm_getcsr();
}
void write_mode(unsigned long long mode) {
  _mm_setcsr(static_cast<unsigned>(mode));
}
constexpr unsigned long long kDefaultMode = kDefaultMxcsr;
#elif defined(__aarch64__)
unsigned long long read_mode() {
  unsigned long long mode;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
void write_mode(unsigned long long mode) {
  asm volatile("msr fpcr, %0" : : "r"(mode));
}
constexpr unsigned long long kDefaultMode = 0;
#else
unsigned long long read_mode() {
  return 0;
}
void write_mode(unsigned long long) {}
constexpr unsigned long long kDefaultMode = 0;
#endif

}  // namespace

StandardFloatingPoint::StandardFloatingPoint()
    : saved_(read_mode()), saved_rounding_(std::fegetround()) {
  // x87 keeps a rounding mode of its own (long double code), hence both.
  if (saved_rounding_ != FE_TONEAREST) std::fesetround(FE_TONEAREST);
  write_mode(kDefaultMode);
}

StandardFloatingPoint::~StandardFloatingPoint() {
  // Asked again, since a callback of the host may have changed the mode in between.
  if (std::fegetround() != saved_rounding_) std::fesetround(saved_rounding_);
  write_mode(saved_);
}

}  // namespace beltrami
