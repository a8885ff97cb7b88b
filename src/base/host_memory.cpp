#include "base/host_memory.h"

namespace beltrami {
namespace {

/// Of the run that this thread is in. Not a parameter: operator new has none.
thread_local const HostMemory* current = nullptr;

}  // namespace

HostMemoryScope::HostMemoryScope(const HostMemory* memory) noexcept : outer_(current) {
  current = memory;
}

HostMemoryScope::~HostMemoryScope() {
  current = outer_;
}

const HostMemory* host_memory() noexcept {
  return current;
}

void* take_memory_or_throw(std::size_t bytes, std::size_t alignment) {
  for (;;) {
    if (void* const block = take_memory(bytes, alignment)) return block;
    // The handler is of another heap than a host's allocator.
    const std::new_handler handler = current == nullptr ? std::get_new_handler() : nullptr;
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace beltrami
