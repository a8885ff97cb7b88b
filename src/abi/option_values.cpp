#include "abi/option_values.h"

#include <beltrami/beltrami.h>

#include <charconv>
#include <string>

#include "abi/option_entry.h"
#include "abi/option_table.h"
#include "base/error.h"

namespace beltrami {
namespace {

/// The shortest text that reads back to the value, whatever the host's locale.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

const OptionEntry& require_option(std::int32_t key) {
  const OptionEntry* option = find_option(key);
  if (option != nullptr) return *option;
  throw Error(Fault::kInvalidArgument, "there is no option with key " + std::to_string(key) +
                                           ": keys run from 0 to " +
                                           std::to_string(option_table().size() - 1));
}

const OptionEntry& require_option(std::int32_t key, bool is_float) {
  const OptionEntry& option = require_option(key);
  if (is_float != (option.type == BELTRAMI_TYPE_FLOAT)) {
    throw Error(Fault::kInvalidArgument, std::string("the option ") + option.name +
                                             " is set by beltrami_set_" +
                                             (is_float ? "int" : "float"));
  }
  return option;
}

[[noreturn]] void refuse_value(const OptionEntry& option, const std::string& value) {
  std::string message = value + " is out of range for the option " + option.name +
                        ": give a number from " + number(option.minimum) + " to " +
                        number(option.maximum);
  const char* separator = " (";
  for (const char* choice : option.choices) {
    message += separator;
    message += choice;
    separator = ", ";
  }
  if (!option.choices.empty()) message += ")";
  throw Error(Fault::kInvalidArgument, message);
}

}  // namespace

void set_int_option(Options& options, std::int32_t key, std::int64_t value) {
  const OptionEntry& option = require_option(key, false);
  if (value < static_cast<std::int64_t>(option.minimum) ||
      value > static_cast<std::int64_t>(option.maximum)) {
    refuse_value(option, std::to_string(value));
  }
  option.set(options, static_cast<double>(value));
}

void set_float_option(Options& options, std::int32_t key, double value) {
  const OptionEntry& option = require_option(key, true);
  // Written so that NaN is refused, too.
  if (!(value >= option.minimum && value <= option.maximum)) refuse_value(option, number(value));
  option.set(options, value);
}

double get_option(const Options& options, std::int32_t key) {
  return require_option(key).get(options);
}

}  // namespace beltrami
