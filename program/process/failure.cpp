#include "process/failure.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include "process/descriptor.h"
#include "process/leftovers.h"

namespace beltrami::cli {
namespace {

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// Why the process is being terminated. Rethrowing needs no memory, other than copying would.
int tell_reason() noexcept {
  if (!std::current_exception()) {
    // An exception for which there was no memory looks like this, too.
    return tell(kExitInternal, {"beltrami: out of memory, or an internal failure"});
  }
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return tell(kExitInternal, {"beltrami: out of memory"});
  } catch (const std::exception& error) {
    return tell(kExitInternal, {"beltrami: internal failure: ", error.what()});
  } catch (...) {
    return tell(kExitInternal, {"beltrami: internal failure"});
  }
}

}  // namespace

int exit_code_of(beltrami_status status) {
  switch (status) {
    case BELTRAMI_OK:
    case BELTRAMI_NOT_CONVERGED:
      return kExitInjective;
    case BELTRAMI_NOT_INJECTIVE:
    case BELTRAMI_NOT_INJECTIVE_FLOAT32:
      return kExitNotInjective;
    case BELTRAMI_E_CANCELLED:
      return kExitCancelled;
    case BELTRAMI_E_OUT_OF_MEMORY:
    case BELTRAMI_E_ABI_MISMATCH:
    case BELTRAMI_E_INVALID_STATE:
    case BELTRAMI_E_INTERNAL:
    case BELTRAMI_E_SOLVER:
      return kExitInternal;
    default:  // the arguments or the mesh
      return kExitUnusable;
  }
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (is_control(c)) c = ' ';
  }
  return text;
}

int tell(int exit_code, std::initializer_list<std::string_view> parts) noexcept {
  static std::atomic<int> told{0};
  int none = 0;
  if (!told.compare_exchange_strong(none, exit_code)) return none;
  std::array<char, 4096>
      line;  // in one piece, if it fits, so that other programs' lines do not mix
  std::size_t used = 0;
  for (const std::string_view part : parts) {
    for (const char c : part) {
      line[used++] = is_control(c) ? ' ' : c;
      if (used == line.size()) write_all(kStandardError, {line.data(), std::exchange(used, 0)});
    }
  }
  line[used++] = '\n';
  write_all(kStandardError, {line.data(), used});  // where else could a failure be told?
  return exit_code;
}

int print(std::string_view text, const char* what, int exit_code) noexcept {
  if (write_all(kStandardOutput, text)) return exit_code;
  const char* reason = std::strerror(errno);
  return tell(kExitUnprinted, {"beltrami: standard output: ", what, " is lost: ", reason});
}

void remark(std::string_view line) noexcept {
  write_all(kStandardError, line);
}

void install_terminate_handler() noexcept {
  std::set_terminate([] {
    remove_leftovers();
    std::_Exit(tell_reason());
  });
}

}  // namespace beltrami::cli
