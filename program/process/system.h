// What the program asks of the system beside files and signals.
#pragma once

#include <cstdint>

namespace beltrami::cli {

/// Greatest resident memory of the whole process so far, in bytes; 0 where the system does not say.
std::uint64_t peak_memory_bytes();

/// Cores that the process may use, at least one: not all that there are, under taskset or a job
/// scheduler.
std::int64_t usable_cores();

/// Whether standard error is a terminal that takes escape sequences.
bool stderr_is_terminal();

/// Columns of the terminal of standard error at this moment: it may be resized. A guess where it
/// does not say.
int stderr_columns();

/// Text is UTF-8, whatever the console takes it for. Call it first.
void prepare_console();

}  // namespace beltrami::cli
