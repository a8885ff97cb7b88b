// Files by descriptor: system calls that a signal can end, and that need no memory.
#pragma once

#include <string>
#include <string_view>

namespace beltrami::cli {

inline constexpr int kStandardOutput = 1, kStandardError = 2;

/// Keeps the standard descriptors from becoming those of files: a missing one is taken by one that
/// can be neither read from nor written to.
void reserve_standard_descriptors() noexcept;

/// Opens what is not a regular file, for writing. Waits for somebody to read a pipe. Returns -1 and
/// sets errno on failure: EINTR where interrupted() while it waits.
int open_special(const char* path) noexcept;

/// Writes all of `bytes`, waiting for room. Returns false and sets errno on failure: EINTR where
/// interrupted() while it waits.
bool write_all(int descriptor, std::string_view bytes) noexcept;

/// Has the device store a file, or a directory. Returns false and sets errno on failure; that there
/// is nothing to store (pipes, some file systems) is none.
bool sync(int descriptor) noexcept;
bool sync_directory(const char* path) noexcept;

/// The bytes of the file at `path`, whatever it is (a regular file, a pipe). Throws Failure with
/// the path, that of a cancelled command where interrupted(); std::bad_alloc.
std::string read_file(const std::string& path);

}  // namespace beltrami::cli
