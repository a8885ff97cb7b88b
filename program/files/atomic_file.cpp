#include "files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <random>
#include <utility>

#include "process/descriptor.h"
#include "process/failure.h"

#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>

#include <csignal>
#endif

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

#if defined(_WIN32)
constexpr int kFlags = O_WRONLY | O_BINARY;
bool may_write(const char* path) {
  return access(path, 2) == 0;
}
void set_permissions(int, fs::perms) {}  // it only knows "read only", and such a file is refused
#else
// Of no meaning for regular files, but it tells write_all() that they take any number of bytes.
constexpr int kFlags = O_WRONLY | O_CLOEXEC | O_NONBLOCK;
bool may_write(const char* path) {
  return faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) == 0;
}
void set_permissions(int descriptor, fs::perms permissions) {
  // Not every file system has them.
  static_cast<void>(fchmod(descriptor, static_cast<mode_t>(permissions)));
}
#endif

fs::path follow_links(const std::string& path) {
  std::error_code error;
  fs::path target = path;
  // Links can form a loop; the system gives up after 40 of them as well.
  for (int hop = 0; hop < 40 && fs::is_symlink(target, error); ++hop) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) throw Failure(path + ": cannot be written: " + error.message());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

/// A name beside `target` that tells whose temporary it is, random so that runs do not meet.
fs::path temporary_beside(const fs::path& target) {
  std::random_device random;
  // Cut short, since a name that is as long as the file system allows would not take the rest.
  const std::string name = target.filename().string().substr(0, 100);
  return target.parent_path() / ("." + name + "." + std::to_string(random()) + ".tmp");
}

#if defined(_WIN32)
class HoldSignals {};  // a console's handlers run on a thread of their own
#else
/// While it lives, signals wait.
class HoldSignals {
 public:
  HoldSignals() {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before_);
  }
  ~HoldSignals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HoldSignals(const HoldSignals&) = delete;
  HoldSignals& operator=(const HoldSignals&) = delete;

 private:
  sigset_t before_{};
};
#endif

/// Of what is at `path`, links followed. Throws Failure for a directory.
fs::file_status status_of(const std::string& path) {
  if (path.empty()) throw Failure("an output path is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw Failure(path + ": cannot be written: is a directory");
  return status;
}

bool is_special(const fs::file_status& status) {
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  const fs::file_status status = status_of(path);
  if (is_special(status)) {
    descriptor_ = open_special(path.c_str());
    if (descriptor_ < 0) fail("cannot be written");
    return;
  }
  const fs::path target = follow_links(path);
  target_ = target.string();
  folder_ = target.has_parent_path() ? target.parent_path().string() : ".";
  // Renaming would replace a write-protected file; the user protected it for a reason.
  replaces_ = fs::exists(status);
  if (replaces_ && !may_write(target_.c_str())) fail("cannot be written");
  // Before it exists: a signal may come between any two steps.
  temporary_.emplace(temporary_beside(target).string());
  descriptor_ = open(temporary_->path().c_str(), kFlags | O_CREAT | O_EXCL, 0666);
  if (descriptor_ < 0) {
    temporary_->keep();
    fail("cannot be written");
  }
  if (replaces_) set_permissions(descriptor_, status.permissions());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::write(std::string_view bytes) {
  if (!write_all(descriptor_, bytes)) fail("cannot be written");
}

void AtomicFile::close() {
  if (descriptor_ < 0) return;
  const bool stored = !temporary_ || sync(descriptor_);
  const int number = errno;
  const bool closed = ::close(std::exchange(descriptor_, -1)) == 0 || errno == EINTR;
  if (stored && closed) return;
  if (!stored) errno = number;
  fail("cannot be written");
}

void AtomicFile::commit() {
  close();
  put_in_place();
  finish();
}

void AtomicFile::keep_old() {
  if (!temporary_ || !replaces_) return;
  old_.emplace(temporary_beside(target_).string());
  // A second name costs nothing, and is there at any moment. Not every file system has such: then
  // the old file cannot come back.
  std::error_code error;
  fs::create_hard_link(target_, old_->path(), error);
  if (!error) return;
  old_->keep();
  old_.reset();
}

void AtomicFile::put_in_place() {
  if (!temporary_) return;
#if defined(_WIN32)
  fs::rename(temporary_->path(), target_);  // the C library's does not replace
#else
  if (std::rename(temporary_->path().c_str(), target_.c_str()) != 0) fail("cannot be replaced");
#endif
  in_place_ = true;
  temporary_->keep();
  temporary_.reset();
  // The file has its name now. That the name outlives a power cut is asked for, but where a folder
  // cannot be opened or synchronised, nothing is wrong with the file.
  sync_directory(folder_.c_str());
}

void AtomicFile::finish() noexcept {
  old_.reset();
  for (const std::string& path : obsolete_) std::remove(path.c_str());
}

void AtomicFile::take_back() noexcept {
  if (!in_place_) return;
  if (!replaces_) {
    std::remove(target_.c_str());
  } else if (old_ && std::rename(old_->path().c_str(), target_.c_str()) == 0) {
    old_->keep();
  }
  in_place_ = false;
}

void commit(std::deque<AtomicFile>& files) {
  for (AtomicFile& file : files) file.close();
  for (AtomicFile& file : files) file.keep_old();
  [[maybe_unused]] const HoldSignals hold;
  try {
    for (AtomicFile& file : files) file.put_in_place();
  } catch (...) {
    for (AtomicFile& file : files) file.take_back();
    throw;
  }
  for (AtomicFile& file : files) file.finish();
}

void AtomicFile::fail(const char* what) const {
  const int number = errno;
  if (number == ENOMEM) throw std::bad_alloc();
  if (number == EINTR) throw Failure(BELTRAMI_E_CANCELLED, "cancelled");
  throw Failure(path_ + ": " + what + ": " + std::strerror(number));
}

void require_writable(const std::string& path) {
  if (is_special(status_of(path))) {
    if (!may_write(path.c_str())) {
      throw Failure(path + ": cannot be written: " + std::strerror(errno));
    }
    return;
  }
  const AtomicFile probe(path);
}

}  // namespace beltrami::cli
