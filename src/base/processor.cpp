#include "base/processor.h"

#if defined(__GNUC__) && defined(__x86_64__)
#include <cpuid.h>
#endif

namespace beltrami {

#if defined(__GNUC__) && defined(__x86_64__)

namespace {

struct Registers {
  unsigned a = 0, b = 0, c = 0, d = 0;
};

/// All zero where the processor does not know the leaf.
Registers ask(unsigned leaf) {
  Registers r;
  if (__get_cpuid_count(leaf, 0, &r.a, &r.b, &r.c, &r.d) == 0) return {};
  return r;
}

}  // namespace

bool has_avx2() {
  constexpr unsigned kSystemSavesState = 1u << 27, kAvx = 1u << 28, kAvx2 = 1u << 5;
  const unsigned features = ask(1).c;
  if ((features & kSystemSavesState) == 0 || (features & kAvx) == 0) return false;
  unsigned low = 0, high = 0;
  __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  constexpr unsigned kUpperHalves = 6;  // the system keeps the registers of SSE and AVX
  return (low & kUpperHalves) == kUpperHalves && (ask(7).b & kAvx2) != 0;
}

bool has_popcnt() {
  constexpr unsigned kPopcnt = 1u << 23;
  return (ask(1).c & kPopcnt) != 0;
}

#else

bool has_avx2() {
  return false;
}

bool has_popcnt() {
  return false;
}

#endif

}  // namespace beltrami
