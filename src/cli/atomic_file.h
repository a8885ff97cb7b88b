// Files that appear whole or not at all.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// Writes to a temporary beside `path` and renames it over `path` on commit(); without a commit the
/// temporary is removed and `path` stays as it was. A link is followed, the permissions of an
/// existing target are kept, and what is not a regular file (a device, a pipe) is written directly.
/// Every failure throws Failure with the path.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// Writes out what is buffered, so that a full disk shows before anything is replaced.
  void close();
  /// Closes, and replaces the target.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;    ///< as the user gave it, for messages
  std::string target_;  ///< links followed
  std::string temporary_;
  std::FILE* file_ = nullptr;
};

/// Throws Failure unless `path` could be written now: told before minutes of work, not after.
void require_writable(const std::string& path);

}  // namespace beltrami::cli
