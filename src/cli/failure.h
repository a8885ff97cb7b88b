// How the program fails: an exit code, one sentence, and the element concerned.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace beltrami::cli {

/// Exit codes: part of the interface, scripts branch on them (docs/report.md).
enum ExitCode : int {
  kExitInjective = 0,
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
      : std::runtime_error(message),
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
};

/// `text` on one line, for stderr: control characters become spaces.
std::string one_line(std::string text);

}  // namespace beltrami::cli
