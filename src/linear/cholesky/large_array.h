// Arrays of numbers that are too large to be touched in vain.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#elif defined(_WIN32)
#include <malloc.h>
#endif

namespace beltrami {

struct FreeDeleter {
#if defined(_WIN32)
  void operator()(void* p) const {
    _aligned_free(p);
  }
#else
  void operator()(void* p) const {
    std::free(p);
  }
#endif
};

/// Uninitialised numbers.
template <class T>
using LargeArray = std::unique_ptr<T[], FreeDeleter>;

/// Throws std::bad_alloc. Nothing is cleared, and large arrays use large pages where the system has
/// them: the first touch of ordinary pages costs as much as the factorization itself.
template <class T>
LargeArray<T> allocate_large(std::int64_t count) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  const std::size_t wanted = static_cast<std::size_t>(count > 0 ? count : 1);
  if (wanted > (SIZE_MAX - kLargePage) / sizeof(T)) throw std::bad_alloc();
  const std::size_t bytes = wanted * sizeof(T);
  const bool large = bytes >= 4 * kLargePage;
  const std::size_t alignment = large ? kLargePage : 64;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
#if defined(_WIN32)
  void* const memory = _aligned_malloc(rounded, alignment);
#else
  void* const memory = std::aligned_alloc(alignment, rounded);
#endif
  if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  if (large) madvise(memory, rounded, MADV_HUGEPAGE);  // a hint: failure changes nothing
#endif
  return LargeArray<T>(static_cast<T*>(memory));
}

}  // namespace beltrami
