// Files that must not stay behind when the process ends without unwinding.
#pragma once

#include <string>

namespace beltrami::cli {

/// Removes every file that a Leftover names. Safe in a signal handler.
void remove_leftovers() noexcept;

/// A file that is removed when this ends, or by remove_leftovers() while it lives. Not so by the
/// latter if its name has more than 4,095 bytes, or if there are more than 64 at a time.
class Leftover {
 public:
  /// The file need not exist yet.
  explicit Leftover(std::string path);
  ~Leftover();
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  const std::string& path() const { return path_; }
  /// From now on the file is not removed: it is another's, or has another name.
  void keep() noexcept;

 private:
  std::string path_;
  int slot_ = -1;
};

}  // namespace beltrami::cli
