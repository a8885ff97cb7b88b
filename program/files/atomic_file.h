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

 private:
  friend void commit(std::deque<AtomicFile>& files);
  /// Keeps what is at the target for take_back(), where the file system can.
  void keep_old();
  void put_in_place();
  /// Removes what nothing needs any more.
  void finish() noexcept;
  void take_back() noexcept;
  [[noreturn]] void fail(const char* what) const;

  std::string path_;    ///< as the user gave it, for messages
  std::string target_;  ///< links followed
  std::string folder_;  ///< of the target
  std::optional<Leftover> temporary_;
  std::vector<std::string> obsolete_;
  std::optional<Leftover> old_;  ///< another name of what is at the target
  bool replaces_ = false;        ///< something is there
  bool in_place_ = false;
  int descriptor_ = -1;
};

/// Commits all files, in their order, or none: where one cannot be put in place, those before it
/// are taken back, and what was there is there again. No signal but SIGKILL comes between. Throws
/// Failure; needs no memory once something is replaced.
void commit(std::deque<AtomicFile>& files);

/// Throws Failure unless `path` could be written now: told before minutes of work, not after. What
/// is not a regular file is not opened, since the reader of a pipe would notice.
void require_writable(const std::string& path);

}  // namespace beltrami::cli
