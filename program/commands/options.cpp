#include "commands/options.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "process/failure.h"
#include "process/system.h"

namespace beltrami::cli {
namespace {

std::string plain_number(double value) {
  char digits[64];
  if (std::abs(value) < 1e15 && value == std::floor(value)) {
    std::snprintf(digits, sizeof digits, "%.0f", value);
  } else {
    std::snprintf(digits, sizeof digits, "%g", value);
  }
  return digits;
}

std::string default_word(const Option& option) {
  if (option.is_thread_count()) return "all cores";
  if (option.info.type != BELTRAMI_TYPE_CHOICE) return plain_number(option.info.default_value);
  const auto value = static_cast<std::size_t>(option.info.default_value);
  return value < option.choices.size() ? option.choices[value] : plain_number(double(value));
}

std::string joined_choices(const Option& option, const char* separator) {
  std::string all;
  for (const std::string& choice : option.choices) all += (all.empty() ? "" : separator) + choice;
  return all;
}

std::string range_of(const Option& option) {
  return plain_number(option.info.minimum) + " to " + plain_number(option.info.maximum);
}

/// "Turns each chart" for "1 turns each chart": a flag takes no number.
std::string said_of_flag(const std::string& summary) {
  if (!summary.starts_with("1 ")) return summary;
  std::string text = summary.substr(2);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string help_text(const Option& option) {
  std::string text = option.info.summary;
  if (option.is_flag()) return said_of_flag(text);
  if (option.is_byte_count())
    text += " K, M and G behind the number multiply it by powers of 1024.";
  text += " [";
  if (option.info.type != BELTRAMI_TYPE_CHOICE) text += range_of(option) + "; ";
  return text + "default " + default_word(option) + "]";
}

template <class Number>
std::string parse_number(const std::string& text, const Option& option, Number& value) {
  Number parsed = 0;
  const char* end = text.data() + text.size();
  const auto [past, error] = std::from_chars(text.data(), end, parsed);
  // Negated so that NaN fails too.
  if (error == std::errc() && past == end && double(parsed) >= option.info.minimum &&
      double(parsed) <= option.info.maximum) {
    value = parsed;
    return "";
  }
  const char* kind = option.info.type == BELTRAMI_TYPE_INT ? "a whole number" : "a number";
  return "'" + text + "' is not " + kind + " from " + range_of(option);
}

/// A number of bytes with a unit or without: "1048576", "1024K", "1M".
std::string parse_bytes(const std::string& text, Option& option) {
  constexpr std::string_view kUnits = "KMG";
  const std::size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  if (unit == std::string_view::npos) return parse_number(text, option, option.integer);
  const std::int64_t factor = std::int64_t{1024} << (10 * unit);
  Option scaled = option;
  scaled.info.maximum = std::floor(option.info.maximum / static_cast<double>(factor));
  const std::string number(text, 0, text.size() - 1);
  if (!parse_number(number, scaled, scaled.integer).empty()) {
    return "'" + text + "' is not a whole number of bytes from " + range_of(option);
  }
  option.integer = scaled.integer * factor;
  return "";
}

}  // namespace

std::string parse_option(const std::string& text, Option& option) {
  if (option.is_byte_count()) return parse_bytes(text, option);
  if (option.info.type == BELTRAMI_TYPE_INT) return parse_number(text, option, option.integer);
  if (option.info.type == BELTRAMI_TYPE_FLOAT) return parse_number(text, option, option.real);
  for (std::size_t i = 0; i < option.choices.size(); ++i) {
    if (option.choices[i] != text) continue;
    option.integer = static_cast<std::int64_t>(i);
    return "";
  }
  return "'" + text + "' is not one of " + joined_choices(option, ", ");
}

Options::Options(std::int32_t call) : call_(call) {
  for (std::int32_t key = 0;; ++key) {
    Option option;
    option.info.struct_size = sizeof option.info;
    if (beltrami_option_describe(key, &option.info) != BELTRAMI_OK) break;
    if ((option.info.calls & call) == 0) continue;
    option.integer = static_cast<std::int64_t>(option.info.default_value);
    option.real = option.info.default_value;
    if (option.is_thread_count()) {
      option.integer = std::min(usable_cores(), static_cast<std::int64_t>(option.info.maximum));
    }
    if (option.info.type == BELTRAMI_TYPE_CHOICE) {
      for (std::int32_t value = 0; const char* name = beltrami_option_choice(key, value); ++value) {
        option.choices.emplace_back(name);
      }
    }
    options_.push_back(std::move(option));
  }
}

void Options::add_to(CLI::App& command) {
  for (Option& option : options_) {
    const std::string flag = std::string("--") + option.info.name;
    const std::int32_t calls = option.info.calls;
    const bool of_pages = option.info.key == BELTRAMI_OPTION_PACK ||
                          calls == (BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK);
    const char* group = of_pages                        ? "Pages"
                        : calls == BELTRAMI_CALL_UNWRAP ? "Charts"
                        : call_ == BELTRAMI_CALL_PACK   ? "Run"
                                                        : "Flattening";
    if (option.is_flag()) {
      command
          .add_flag_callback(
              flag, [&option] { option.integer = option.given = true; }, help_text(option))
          ->group(group);
      continue;
    }
    const auto parse = [&option, flag](const std::string& text) {
      const std::string error = parse_option(text, option);
      if (!error.empty()) throw CLI::ValidationError(flag, error);
      option.given = true;
    };
    command.add_option_function<std::string>(flag, parse, help_text(option))
        ->group(group)
        ->type_name(option.info.type == BELTRAMI_TYPE_CHOICE  ? joined_choices(option, "|")
                    : option.info.type == BELTRAMI_TYPE_FLOAT ? "X"
                    : option.is_byte_count()                  ? "BYTES"
                                                              : "N");
  }
}

void Options::apply_to(beltrami_context* context) {
  // In the order of the keys, in which a preset comes before the options that it sets.
  for (const Option& option : options_) {
    if (!option.given && !option.is_thread_count()) continue;
    const beltrami_status status = option.info.type == BELTRAMI_TYPE_FLOAT
                                       ? beltrami_set_float(context, option.info.key, option.real)
                                       : beltrami_set_int(context, option.info.key, option.integer);
    if (status < 0) {
      throw Failure(status,
                    std::string("--") + option.info.name + ": " + beltrami_error_message(context));
    }
  }
  for (Option& option : options_) {
    if (beltrami_get_option(context, option.info.key, &option.real) != BELTRAMI_OK) continue;
    option.integer = static_cast<std::int64_t>(option.real);
  }
}

void Options::set(std::int32_t key, std::int64_t value) {
  for (Option& option : options_) {
    if (option.info.key != key) continue;
    option.given = true;
    option.integer = value;
  }
}

OptionValues Options::values() const {
  OptionValues values;
  for (const Option& option : options_) {
    const std::string name = option.info.name;
    if (option.is_flag()) {
      values.emplace_back(name, option.integer != 0);
    } else if (option.info.type == BELTRAMI_TYPE_FLOAT) {
      values.emplace_back(name, option.real);
    } else if (option.info.type == BELTRAMI_TYPE_CHOICE) {
      values.emplace_back(name, option.choices.at(static_cast<std::size_t>(option.integer)));
    } else {
      values.emplace_back(name, option.integer);
    }
  }
  return values;
}

bool Options::use_fewer_threads() {
  for (Option& option : options_) {
    if (!option.is_thread_count() || option.given || option.integer == 1) continue;
    option.integer /= 2;
    return true;
  }
  return false;
}

std::int64_t Options::integer(std::int32_t key) const {
  for (const Option& option : options_) {
    if (option.info.key == key) return option.integer;
  }
  return 0;
}

double Options::real(std::int32_t key) const {
  for (const Option& option : options_) {
    if (option.info.key == key) return option.real;
  }
  return 0;
}

}  // namespace beltrami::cli
