#include "atomic_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>

#include "failure.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

fs::path follow_links(const std::string& path) {
  std::error_code error;
  fs::path target = path;
  // Links can form a loop; the system gives up after 40 of them as well.
  for (int hop = 0; hop < 40 && fs::is_symlink(target, error); ++hop) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
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

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  if (path.empty()) throw Failure("an output path is empty");
  const fs::path target = follow_links(path);
  target_ = target.string();
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) throw Failure(path_ + ": cannot be written: is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    file_ = std::fopen(target_.c_str(), "wb");
    if (!file_) fail("cannot be written");
    return;
  }
  if (fs::exists(status)) {
    // Renaming would replace a write-protected file; the user protected it for a reason.
    std::FILE* existing = std::fopen(target_.c_str(), "r+b");
    if (!existing) fail("cannot be written");
    std::fclose(existing);
  }
  temporary_ = temporary_beside(target).string();
  file_ = std::fopen(temporary_.c_str(), "wbx");
  if (!file_) {
    const int number = errno;
    temporary_.clear();
    errno = number;
    fail("cannot be written");
  }
  if (fs::exists(status)) fs::permissions(temporary_, status.permissions(), error);
}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
}

void AtomicFile::close() {
  if (!file_) return;
  const bool flushed = std::fflush(file_) == 0;
  const int number = errno;
  const bool closed = std::fclose(file_) == 0;
  file_ = nullptr;
  if (flushed && closed) return;
  if (!flushed) errno = number;
  fail("cannot be written");
}

void AtomicFile::commit() {
  close();
  if (temporary_.empty()) return;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw Failure(path_ + ": cannot be replaced: " + error.message());
  temporary_.clear();
}

void AtomicFile::fail(const std::string& what) const {
  throw Failure(path_ + ": " + what + ": " + std::strerror(errno));
}

void require_writable(const std::string& path) {
  const AtomicFile probe(path);
}

}  // namespace beltrami::cli
