// Comes before Eigen in every source of the library. Eigen takes memory by std::malloc and has no
// hook. What it calls std, inside its namespace, is this one: the standard library, but for memory.
#pragma once

#include <cstddef>
#include <cstdlib>

#include "base/host_memory.h"

namespace Eigen::std {  // NOLINT(readability-identifier-naming)

using namespace ::std;

inline void* malloc(size_t bytes) noexcept {
  return beltrami::take_memory(bytes);
}
inline void* calloc(size_t count, size_t bytes) noexcept {
  return beltrami::take_cleared_memory(count, bytes);
}
inline void* realloc(void* block, size_t bytes) noexcept {
  return beltrami::resize_memory(block, bytes);
}
inline void free(void* block) noexcept {
  beltrami::give_memory(block);
}

}  // namespace Eigen::std
