// Time and memory that the process has used.
#pragma once

#include <cstdint>

namespace beltrami {

/// Seconds of a steady clock.
double wall_seconds();
/// CPU seconds of all threads of the process.
double cpu_seconds();
/// Greatest resident memory of the process so far, in bytes; 0 where the system does not tell.
std::uint64_t peak_memory_bytes();

}  // namespace beltrami
