#include "process/descriptor.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

#include "process/failure.h"
#include "process/interrupt.h"

#if defined(_WIN32)
#include <io.h>
#else
#include <poll.h>
#include <unistd.h>
#endif

namespace beltrami::cli {
namespace {

#if defined(_WIN32)

// Nothing waits for long here: the system has no pipes with names in its file system.
constexpr int kRead = 0, kWrite = 1;
constexpr std::size_t kPiece = 1 << 30;
bool wait_until_ready(int, int) noexcept {
  return true;
}
std::size_t size_of_write(int, std::size_t wanted) noexcept {
  return std::min(wanted, kPiece);
}
int open_binary(const char* path, int flags) noexcept {
  return open(path, flags | O_BINARY);
}

#else

constexpr int kRead = POLLIN, kWrite = POLLOUT;
constexpr int kPatience = 50;  // milliseconds: no system call waits longer without a look around

/// Returns false and sets errno to EINTR if a signal has asked for an end before data or room came.
/// An error on `descriptor` is left to the read or write that follows.
bool wait_until_ready(int descriptor, int events) noexcept {
  pollfd entry = {descriptor, static_cast<short>(events), 0};
  for (;;) {
    const int ready = poll(&entry, 1, kPatience);
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;
    if (!interrupted()) continue;
    errno = EINTR;
    return false;
  }
}

/// So many bytes that a write does not wait once there is room for any.
std::size_t size_of_write(int descriptor, std::size_t wanted) noexcept {
  constexpr std::size_t kRoomOfPipes = 512;  // the least that POSIX allows
  const bool waits = (fcntl(descriptor, F_GETFL) & O_NONBLOCK) == 0;
  return waits ? std::min(wanted, kRoomOfPipes) : wanted;
}

int open_binary(const char* path, int flags) noexcept {
  return open(path, flags | O_CLOEXEC | O_NOCTTY);
}

#endif

class Closing {
 public:
  explicit Closing(int descriptor) : descriptor_(descriptor) {}
  ~Closing() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Closing(const Closing&) = delete;
  Closing& operator=(const Closing&) = delete;

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::string& path, const char* what) {
  const int number = errno;
  if (number == ENOMEM) throw std::bad_alloc();
  throw_if_interrupted();
  throw Failure(path + ": " + what + ": " + std::strerror(number));
}

}  // namespace

void reserve_standard_descriptors() noexcept {
#if !defined(_WIN32)
  for (int descriptor = 0; descriptor <= kStandardError; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest number that is free. The wrong direction keeps use of it an error.
    if (open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY) != descriptor) return;
  }
#endif
}

int open_special(const char* path) noexcept {
#if defined(_WIN32)
  return open_binary(path, O_WRONLY);
#else
  for (;;) {
    const int descriptor = open_binary(path, O_WRONLY | O_NONBLOCK);
    struct stat status {};
    const bool unread =
        descriptor < 0 && errno == ENXIO && stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
    if (descriptor >= 0 || (!unread && errno != EINTR)) return descriptor;
    if (interrupted()) {
      errno = EINTR;
      return -1;
    }
    poll(nullptr, 0, kPatience);
  }
#endif
}

bool write_all(int descriptor, std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    if (!wait_until_ready(descriptor, kWrite)) return false;
    const auto written = write(descriptor, bytes.data(), size_of_write(descriptor, bytes.size()));
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR && errno != EAGAIN) {
      return false;
    }
  }
  return true;
}

bool sync(int descriptor) noexcept {
#if defined(_WIN32)
  return _commit(descriptor) == 0;
#else
  while (fsync(descriptor) != 0) {
    if (errno == EINVAL || errno == ENOTSUP || errno == EROFS) return true;
    if (errno != EINTR) return false;
  }
  return true;
#endif
}

bool sync_directory(const char* path) noexcept {
#if defined(_WIN32)
  return path != nullptr;  // the system has no such call
#else
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_DIRECTORY);
  if (descriptor < 0) return false;
  const Closing closing(descriptor);
  return sync(descriptor);
#endif
}

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Failure(path + ": is a directory, not a file");
  }
  const int descriptor = open_binary(path.c_str(), O_RDONLY);
  if (descriptor < 0) fail(path, "cannot be opened");
  const Closing closing(descriptor);
  std::string text;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  // One byte more, so that the read that fills the buffer also meets the end of the file.
  text.resize(ignored ? 65536 : static_cast<std::size_t>(size) + 1);
  constexpr std::size_t kPiece = 1 << 24;  // a signal is heard between two
  for (std::size_t used = 0;;) {
    if (used == text.size()) text.resize(2 * text.size());
    throw_if_interrupted();
    if (!wait_until_ready(descriptor, kRead)) fail(path, "cannot be read");
    const auto got = read(descriptor, text.data() + used, std::min(text.size() - used, kPiece));
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got < 0) fail(path, "cannot be read");
    used += static_cast<std::size_t>(got);
    if (got > 0) continue;
    text.resize(used);
    return text;
  }
}

}  // namespace beltrami::cli
