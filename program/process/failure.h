// How the program fails: an exit code, one sentence, and the element concerned.
#pragma once

#include <beltrami/beltrami.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// Exit codes: part of the interface, scripts branch on them (docs/report.md).
enum ExitCode : int {
  kExitInjective = 0,
  kExitUnprinted = 1,     ///< the files are written, but stdout could not be
  kExitUnusable = 2,      ///< arguments, files or mesh
  kExitNotInjective = 3,  ///< a result exists, but it is not injective
  kExitInternal = 4,      ///< out of memory, or a defect
  kExitCancelled = 130    ///< what shells report for SIGINT
};

/// The exit code that belongs to a status of the library.
int exit_code_of(beltrami_status status);

/// Status names in reports of failures that are the program's own, not the library's.
inline constexpr const char* kFileErrorStatus = "FILE_ERROR";

/// Ends a command. what() names the file (and the line, where there is one).
class Failure : public std::runtime_error {
 public:
  /// A file that cannot be read, understood or written.
  explicit Failure(const std::string& message, std::int32_t kind = BELTRAMI_ELEMENT_NONE,
                   std::uint64_t index = BELTRAMI_NO_ELEMENT)
      : std::runtime_error(whole(message)),
        exit_code(kExitUnusable),
        status(kFileErrorStatus),
        element_kind(kind),
        element(index) {}

  /// A refusal of the library, or one that the library has a status for.
  Failure(beltrami_status code, const std::string& message,
          std::int32_t kind = BELTRAMI_ELEMENT_NONE, std::uint64_t index = BELTRAMI_NO_ELEMENT)
      : Failure(message, kind, index) {
    exit_code = exit_code_of(code);
    status = beltrami_status_name(code);
  }

  int exit_code;
  std::string status;
  std::int32_t element_kind;
  std::uint64_t element;

 private:
  /// what() would end at a byte of zero, which a damaged file has.
  static std::string whole(std::string message) {
    std::replace(message.begin(), message.end(), '\0', ' ');
    return message;
  }
};

/// `text` on one line, as a terminal may have it: control characters of all kinds become spaces,
/// what is no UTF-8 question marks.
std::string one_line(std::string_view text);

/// Says why the process fails: `parts` as one line on stderr, shown as by one_line(). Only
/// the first call says anything, since it names what is to be mended first. Returns the exit code
/// of the first call. Needs no memory.
int tell(int exit_code, std::initializer_list<std::string_view> parts) noexcept;

/// The next call of tell() is a first one again: for a process that runs several commands.
void forget_what_was_told() noexcept;

/// Writes `text` to standard output. Returns `exit_code`, or kExitUnprinted once that has been
/// told: `what`, such as "the summary", is lost. Needs no memory.
int print(std::string_view text, const char* what, int exit_code) noexcept;

/// Writes `line`, with its line end, to stderr, where it can be: it is of no consequence. Needs no
/// memory.
void remark(std::string_view line) noexcept;

/// Has std::terminate, which is where exceptions of destructors and of static objects end, remove
/// the temporaries, tell one line and exit with kExitInternal.
void install_terminate_handler() noexcept;

}  // namespace beltrami::cli
