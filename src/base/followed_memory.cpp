// Memory of a library whose operators new and delete no other code sees: they, and Eigen, follow
// the scopes of host_memory.h.
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

#ifdef _WIN32
#include <malloc.h>
#endif

#include "base/host_memory.h"

namespace beltrami {
namespace {

/// Stands before each block that is handed out.
struct alignas(kUsualAlignment) Header {
  const HostMemory* owner;  ///< null: the C library
  std::uint64_t bytes : 58, alignment_log : 6;

  std::size_t alignment() const { return std::size_t{1} << alignment_log; }
};
static_assert(sizeof(Header) == kUsualAlignment);

void* take_from_system(std::size_t bytes, std::size_t alignment) noexcept {
  if (alignment == kUsualAlignment) return std::malloc(bytes);
#ifdef _WIN32
  return _aligned_malloc(bytes, alignment);
#else
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
#endif
}

void give_to_system(void* block, [[maybe_unused]] std::size_t alignment) noexcept {
#ifdef _WIN32
  if (alignment != kUsualAlignment) return _aligned_free(block);
#endif
  std::free(block);
}

Header& header_of(void* block) {
  return static_cast<Header*>(block)[-1];
}

}  // namespace

bool follows_host_memory() noexcept {
  return true;
}

void* take_memory(std::size_t bytes, std::size_t alignment) noexcept {
  if (bytes > std::numeric_limits<std::size_t>::max() / 4 - alignment) return nullptr;
  const HostMemory* const owner = host_memory();
  const std::size_t whole = bytes + alignment;  // the header lies in what aligns the block
  void* const start = owner != nullptr ? owner->allocate(owner->user, whole, alignment)
                                       : take_from_system(whole, alignment);
  if (start == nullptr) return nullptr;
  void* const block = static_cast<char*>(start) + alignment;
  const auto log = static_cast<std::uint64_t>(std::countr_zero(alignment));
  new (&header_of(block)) Header{owner, whole, log};
  return block;
}

void* take_cleared_memory(std::size_t count, std::size_t bytes) noexcept {
  if (bytes > 0 && count > std::numeric_limits<std::size_t>::max() / bytes) return nullptr;
  void* const block = take_memory(count * bytes);
  if (block != nullptr) std::memset(block, 0, count * bytes);
  return block;
}

void* resize_memory(void* block, std::size_t bytes) noexcept {
  void* const larger = take_memory(bytes);
  if (larger == nullptr || block == nullptr) return larger;
  const std::size_t had = header_of(block).bytes - kUsualAlignment;
  std::memcpy(larger, block, had < bytes ? had : bytes);
  give_memory(block);
  return larger;
}

void give_memory(void* block) noexcept {
  if (block == nullptr) return;
  const Header header = header_of(block);
  void* const start = static_cast<char*>(block) - header.alignment();
  if (header.owner == nullptr) return give_to_system(start, header.alignment());
  header.owner->release(header.owner->user, start, header.bytes, header.alignment());
}

}  // namespace beltrami

// Where the C++ library is visible from outside, they have other names: cmake/toolchains.
#ifndef __APPLE__

using beltrami::aligned_for;
using beltrami::give_memory;
using beltrami::take_memory;
using beltrami::take_memory_or_throw;

void* operator new(std::size_t bytes) {
  return take_memory_or_throw(bytes);
}
void* operator new[](std::size_t bytes) {
  return take_memory_or_throw(bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return take_memory_or_throw(bytes, aligned_for(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return take_memory_or_throw(bytes, aligned_for(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return take_memory(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return take_memory(bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return take_memory(bytes, aligned_for(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
  return take_memory(bytes, aligned_for(alignment));
}

void operator delete(void* block) noexcept {
  give_memory(block);
}
void operator delete[](void* block) noexcept {
  give_memory(block);
}
void operator delete(void* block, std::size_t) noexcept {
  give_memory(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  give_memory(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  give_memory(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
  give_memory(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  give_memory(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
  give_memory(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  give_memory(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
  give_memory(block);
}
void operator delete(void* block, std::align_val_t, const std::nothrow_t&) noexcept {
  give_memory(block);
}
void operator delete[](void* block, std::align_val_t, const std::nothrow_t&) noexcept {
  give_memory(block);
}

#endif
