// Memory where operators new and delete are the program's: all of it is the C library's.
#include <cstdlib>

#ifdef _WIN32
#include <malloc.h>
#endif

#include "base/host_memory.h"

namespace beltrami {

bool follows_host_memory() noexcept {
  return false;
}

void* take_memory(std::size_t bytes, std::size_t alignment) noexcept {
#ifdef _WIN32
  return _aligned_malloc(bytes, alignment);
#else
  if (alignment == kUsualAlignment) return std::malloc(bytes);
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
#endif
}

void* take_cleared_memory(std::size_t count, std::size_t bytes) noexcept {
#ifdef _WIN32
  return _aligned_recalloc(nullptr, count, bytes, kUsualAlignment);
#else
  return std::calloc(count, bytes);
#endif
}

void* resize_memory(void* block, std::size_t bytes) noexcept {
#ifdef _WIN32
  return _aligned_realloc(block, bytes, kUsualAlignment);
#else
  return std::realloc(block, bytes);
#endif
}

void give_memory(void* block) noexcept {
#ifdef _WIN32
  _aligned_free(block);
#else
  std::free(block);
#endif
}

}  // namespace beltrami
