// Where the memory of a call comes from: an allocator of the host's, or the C library.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>

namespace beltrami {

/// An allocator of the host's. Both functions may be called from any thread of a call, several at a
/// time; neither throws.
struct HostMemory {
  void* user = nullptr;
  /// Null where none is left. `alignment` is a power of two.
  void* (*allocate)(void* user, std::uint64_t bytes, std::uint64_t alignment) = nullptr;
  /// With what `allocate` was asked for.
  void (*release)(void* user, void* block, std::uint64_t bytes, std::uint64_t alignment) = nullptr;
};

/// Has this thread take memory from `memory`, or where that is null from the C library, until
/// destruction. Scopes nest. A block goes back to where it came from, in whichever scope.
class HostMemoryScope {
 public:
  explicit HostMemoryScope(const HostMemory* memory) noexcept;
  ~HostMemoryScope();
  HostMemoryScope(const HostMemoryScope&) = delete;
  HostMemoryScope& operator=(const HostMemoryScope&) = delete;

 private:
  const HostMemory* const outer_;
};

/// That of the innermost scope of this thread, or null.
const HostMemory* host_memory() noexcept;

// What follows is there twice: followed_memory.cpp is linked where operator new and delete of a
// library are its own, system_memory.cpp elsewhere.

/// Whether scopes have an effect.
bool follows_host_memory() noexcept;

constexpr std::size_t kUsualAlignment = 16;  // bytes, as malloc's

/// Uninitialised memory, or null. `alignment` is a power of two, at least kUsualAlignment.
void* take_memory(std::size_t bytes, std::size_t alignment = kUsualAlignment) noexcept;
/// As calloc and realloc, of memory of the usual alignment.
void* take_cleared_memory(std::size_t count, std::size_t bytes) noexcept;
void* resize_memory(void* block, std::size_t bytes) noexcept;
/// Takes back what these have given; null is fine.
void give_memory(void* block) noexcept;

/// As operator new: asks the host's handler for more, and throws std::bad_alloc where there is
/// none.
void* take_memory_or_throw(std::size_t bytes, std::size_t alignment = kUsualAlignment);

/// The alignment to ask for where operator new is asked for this one.
constexpr std::size_t aligned_for(std::align_val_t alignment) {
  return std::max(static_cast<std::size_t>(alignment), kUsualAlignment);
}

}  // namespace beltrami
