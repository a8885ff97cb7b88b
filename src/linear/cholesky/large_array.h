// Arrays of numbers that are too large to be touched in vain.
#pragma once

#include <cstdint>
#include <memory>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "base/host_memory.h"

namespace beltrami {

struct LargeArrayDeleter {
  void operator()(void* p) const { give_memory(p); }
};

/// Uninitialised numbers.
template <class T>
using LargeArray = std::unique_ptr<T[], LargeArrayDeleter>;

/// Throws std::bad_alloc. Nothing is cleared, and large arrays use large pages where the system has
/// them: the first touch of ordinary pages costs as much as the factorization itself.
template <class T>
LargeArray<T> allocate_large(std::int64_t count) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21, kCacheLine = 64;
  const std::size_t wanted = static_cast<std::size_t>(count > 0 ? count : 1);
  if (wanted > (SIZE_MAX - kLargePage) / sizeof(T)) throw std::bad_alloc();
  const std::size_t bytes = wanted * sizeof(T);
  const bool large = bytes >= 4 * kLargePage;
  void* const memory = take_memory(bytes, kCacheLine);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  // A hint, which is not for a host's memory: failure changes nothing.
  if (large && host_memory() == nullptr) {
    void* page = memory;
    std::size_t within = bytes;
    if (std::align(kLargePage, kLargePage, page, within)) madvise(page, within, MADV_HUGEPAGE);
  }
#endif
  return LargeArray<T>(static_cast<T*>(memory));
}

}  // namespace beltrami
