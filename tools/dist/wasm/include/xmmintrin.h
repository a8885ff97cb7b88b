/* Eigen sums in the order of its vectors, and so results have the bits of other processors where
 * vectors are as wide. It has none for WebAssembly: it is given those of SSE2, by SIMDe in plain C,
 * of which the compiler makes WebAssembly's. */
#pragma once
#define SIMDE_ENABLE_NATIVE_ALIASES
#define SIMDE_NO_NATIVE /* its types of WebAssembly are all one, and Eigen tells them apart */
#include <simde/x86/sse2.h>
