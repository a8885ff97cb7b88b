// Files that appear whole or not at all.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "process/leftovers.h"

namespace beltrami::cli {

/// Writes to a temporary beside `path` and renames it over `path` on commit(); without a commit the
/// temporary is removed and `path` stays as it was. A link is followed, and the permissions of an
/// existing target are kept. Other names of the target (hard links) keep the old file: to change it
/// in place would be to lose it if that failed halfway. What is not a regular file (a device, a
/// pipe) is written directly, once somebody reads it.
/// Every failure throws Failure with the path, that of a cancelled command where a signal ends a
/// wait; std::bad_alloc.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// Has the disk store what was written, so that a full one shows before anything is replaced.
  void close();
  /// Has commit() remove this file, which nothing needs once the target is replaced.
  void remove_then(std::string path) { obsolete_.push_back(std::move(path)); }
  /// Closes, and replaces the target. Needs no memory after a close().
  void commit();
  /// Removes the target again if commit() made it where no file was.
  void take_back() noexcept;

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string path_;    ///< as the user gave it, for messages
  std::string target_;  ///< links followed
  std::string folder_;  ///< of the target
  std::optional<Leftover> temporary_;
  std::vector<std::string> obsolete_;
  int descriptor_ = -1;
  bool is_new_ = false;  ///< there is no target
  bool made_ = false;    ///< commit() made one
};

/// Commits all of them in order. Where one cannot be, those before it that are new are taken back,
/// so that no part of a model stays of which the rest is missing.
void commit(std::deque<AtomicFile>& files);

/// Throws Failure unless `path` could be written now: told before minutes of work, not after. What
/// is not a regular file is not opened, since the reader of a pipe would notice.
void require_writable(const std::string& path);

}  // namespace beltrami::cli
