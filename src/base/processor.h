// What the processor can do. Asking takes microseconds, on a virtual machine many, and leaves
// nothing behind: not __builtin_cpu_supports, which keeps its answer in variables of the library.
#pragma once

namespace beltrami {

/// AVX2, and a system that keeps its registers.
bool has_avx2();
bool has_popcnt();

}  // namespace beltrami
