// The options of a run, as the library describes them: this program knows none by itself, but for
// which of them counts bytes, and which threads: by default it uses all cores.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <string>
#include <vector>

#include "commands/report.h"

namespace CLI {
class App;
}

namespace beltrami::cli {

struct Option {
  beltrami_option_info info{};
  std::vector<std::string> choices;  ///< of a choice: names by value
  std::int64_t integer = 0;          ///< value of an integer or a choice
  double real = 0;                   ///< value of a float
  bool given = false;                ///< on the command line

  /// Integers from 0 to 1 are flags without a value.
  bool is_flag() const {
    return info.type == BELTRAMI_TYPE_INT && info.minimum == 0 && info.maximum == 1;
  }
  /// Bytes may be given in units: 512M.
  bool is_byte_count() const { return info.key == BELTRAMI_OPTION_MEMORY_LIMIT; }
  bool is_thread_count() const { return info.key == BELTRAMI_OPTION_THREADS; }
};

class Options {
 public:
  /// Every option of the library that `call` takes (a BELTRAMI_CALL_ number) at its default,
  /// threads at the cores that the process may use.
  explicit Options(std::int32_t call);
  /// The command line refers to the options.
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  /// In the help, what only unwrap takes stands under "Charts", and what is said of pages under
  /// "Pages".
  void add_to(CLI::App& command);
  /// Sets what was given, and the number of threads, in a new context, and takes over what the
  /// others have there: a preset sets several. Throws Failure with the library's words if it
  /// refuses a value.
  void apply_to(beltrami_context* context);
  /// Has the integer option `key` as if it had been given so.
  void set(std::int32_t key, std::int64_t value);
  /// Values by name, e.g. {"method": "cm", "unit-square": false}.
  OptionValues values() const;
  /// Halves the number of threads. Returns false where it is 1, or the user's wish.
  bool use_fewer_threads();
  /// Value of the integer option `key`.
  std::int64_t integer(std::int32_t key) const;
  /// Value of the option `key` of the type float.
  double real(std::int32_t key) const;

 private:
  std::int32_t call_;
  std::vector<Option> options_;
};

/// Sets `option` from the text of the command line. Returns "" or what is wrong with the text.
std::string parse_option(const std::string& text, Option& option);

}  // namespace beltrami::cli
