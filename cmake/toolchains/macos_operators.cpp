// Operators new and delete that stay inside libbeltrami.dylib. Those of the C++ library that is
// linked into it are visible from outside, and zig's linker takes no list of what is to be. They
// are defined by their names in the object file, for the header of the C++ library declares them as
// visible.
#include <cstddef>
#include <new>

#include "base/host_memory.h"

#define BELTRAMI_INSIDE(name) __asm__(name) __attribute__((visibility("hidden")))

using beltrami::aligned_for;
using beltrami::give_memory;
using beltrami::take_memory;
using beltrami::take_memory_or_throw;

extern "C" {

void* one(std::size_t bytes) BELTRAMI_INSIDE("__Znwm");
void* several(std::size_t bytes) BELTRAMI_INSIDE("__Znam");
void* one_aligned(std::size_t bytes, std::size_t alignment)
    BELTRAMI_INSIDE("__ZnwmSt11align_val_t");
void* several_aligned(std::size_t bytes, std::size_t alignment)
    BELTRAMI_INSIDE("__ZnamSt11align_val_t");
void* one_or_none(std::size_t bytes, const std::nothrow_t& none)
    BELTRAMI_INSIDE("__ZnwmRKSt9nothrow_t");
void give_back(void* memory) BELTRAMI_INSIDE("__ZdlPv");
void give_back_several(void* memory) BELTRAMI_INSIDE("__ZdaPv");
void give_back_sized(void* memory, std::size_t) BELTRAMI_INSIDE("__ZdlPvm");
void give_back_several_sized(void* memory, std::size_t) BELTRAMI_INSIDE("__ZdaPvm");
void give_back_aligned(void* memory, std::size_t) BELTRAMI_INSIDE("__ZdlPvSt11align_val_t");
void give_back_several_aligned(void* memory, std::size_t) BELTRAMI_INSIDE("__ZdaPvSt11align_val_t");
void give_back_sized_aligned(void* memory, std::size_t, std::size_t)
    BELTRAMI_INSIDE("__ZdlPvmSt11align_val_t");
void give_back_several_sized_aligned(void* memory, std::size_t, std::size_t)
    BELTRAMI_INSIDE("__ZdaPvmSt11align_val_t");

void* one(std::size_t bytes) {
  return take_memory_or_throw(bytes);
}
void* several(std::size_t bytes) {
  return take_memory_or_throw(bytes);
}
void* one_aligned(std::size_t bytes, std::size_t alignment) {
  return take_memory_or_throw(bytes, aligned_for(std::align_val_t{alignment}));
}
void* several_aligned(std::size_t bytes, std::size_t alignment) {
  return take_memory_or_throw(bytes, aligned_for(std::align_val_t{alignment}));
}
void* one_or_none(std::size_t bytes, const std::nothrow_t&) {
  return take_memory(bytes);
}
void give_back(void* memory) {
  give_memory(memory);
}
void give_back_several(void* memory) {
  give_memory(memory);
}
void give_back_sized(void* memory, std::size_t) {
  give_memory(memory);
}
void give_back_several_sized(void* memory, std::size_t) {
  give_memory(memory);
}
void give_back_aligned(void* memory, std::size_t) {
  give_memory(memory);
}
void give_back_several_aligned(void* memory, std::size_t) {
  give_memory(memory);
}
void give_back_sized_aligned(void* memory, std::size_t, std::size_t) {
  give_memory(memory);
}
void give_back_several_sized_aligned(void* memory, std::size_t, std::size_t) {
  give_memory(memory);
}
}
