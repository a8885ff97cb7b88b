#include "process/failure.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <utility>

#include "process/descriptor.h"
#include "process/leftovers.h"

namespace beltrami::cli {
namespace {

/// Bytes of a character of UTF-8 by its first one; 0 for what begins none.
std::size_t size_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

/// What a terminal obeys instead of showing it: control characters, also those of one byte in
/// Latin-1; breaks of lines, and what turns the direction of writing.
bool is_control(std::uint32_t character) {
  return character < 0x20 || (character >= 0x7F && character < 0xA0) ||
         (character >= 0x200E && character <= 0x200F) ||
         (character >= 0x2028 && character <= 0x202E) ||
         (character >= 0x2066 && character <= 0x2069);
}

/// Takes a character off `text`, and returns what a terminal may have of it.
std::string_view take_shown(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = size_of_character(first);
  std::uint32_t character = size > 1 ? first & (0xFFU >> (size + 1)) : first;
  bool whole = size > 0 && size <= text.size();
  for (std::size_t k = 1; whole && k < size; ++k) {
    const auto next = static_cast<unsigned char>(text[k]);
    whole = (next & 0xC0) == 0x80;
    character = character << 6 | (next & 0x3F);
  }
  const std::string_view as_it_is = text.substr(0, whole ? size : 1);
  text.remove_prefix(as_it_is.size());
  return !whole ? "?" : is_control(character) ? " " : as_it_is;
}

/// The exit code of what was told.
std::atomic<int> told{0};

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

std::string one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) line += take_shown(text);
  return line;
}

int tell(int exit_code, std::initializer_list<std::string_view> parts) noexcept {
  int none = 0;
  if (!told.compare_exchange_strong(none, exit_code)) return none;
  std::array<char, 4096>
      line;  // in one piece, if it fits, so that other programs' lines do not mix
  std::size_t used = 0;
  for (std::string_view part : parts) {
    while (!part.empty()) {
      for (const char c : take_shown(part)) {
        line[used++] = c;
        if (used == line.size()) write_all(kStandardError, {line.data(), std::exchange(used, 0)});
      }
    }
  }
  line[used++] = '\n';
  write_all(kStandardError, {line.data(), used});  // where else could a failure be told?
  return exit_code;
}

void forget_what_was_told() noexcept {
  told = 0;
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
