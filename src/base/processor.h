// What the processor can do. Asking takes microseconds, on a virtual machine many, and leaves
// nothing behind: not __builtin_cpu_supports, which keeps its answer in variables of the library.
#pragma once

/// Whether functions may be compiled for AVX2 beside those for every processor, to be chosen from
/// as the program runs.
#if defined(__GNUC__) && defined(__x86_64__)
#define BELTRAMI_DISPATCH_AVX2 1
#else
#define BELTRAMI_DISPATCH_AVX2 0
#endif

// What is inlined into a function for wider vectors is compiled for wider vectors.
#define BELTRAMI_INLINE [[gnu::always_inline]] inline

namespace beltrami {

/// AVX2, and a system that keeps its registers.
bool has_avx2();
bool has_popcnt();

}  // namespace beltrami
