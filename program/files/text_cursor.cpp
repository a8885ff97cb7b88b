#include "files/text_cursor.h"

#include <charconv>
#include <cstdlib>
#include <cstring>

#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

bool ends_number(const char* at, const char* end) {
  if (at == end) return true;
  switch (*at) {
    case ' ':
    case '\t':
    case '\r':
    case '\n':
    case '\v':
    case '\f':
    case '\\':
      return true;
    default:
      return false;
  }
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Whether a comment begins on this line: it ends with it, whatever its last character is, for
/// names of folders end in a backslash. Within a word # is a part of a name.
bool has_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (at == 0 || is_blank(line[at - 1])) return true;
  }
  return false;
}

/// from_chars leaves numbers beyond the range of a double alone; strtod rounds them, to zero, a
/// subnormal or infinity. The program never sets a locale, so strtod reads a point.
double round_extreme(const char* begin, const char* end) {
  return std::strtod(std::string(begin, end).c_str(), nullptr);
}

}  // namespace

bool TextCursor::skip_continuation() {
  const char* next = at_ + 1;
  if (next != end_ && *next == '\r') ++next;
  if (next == end_ || *next != '\n') return false;
  at_ = next + 1;
  ++line_;
  return true;
}

void TextCursor::skip_line() {
  throw_if_interrupted();
  while (at_ != end_) {
    const void* found = std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
    if (!found) {
      at_ = end_;
      return;
    }
    const char* newline = static_cast<const char*>(found);
    const char* last = newline;
    if (last != at_ && last[-1] == '\r') --last;
    const bool continued = continuations_ && last != at_ && last[-1] == '\\' &&
                           !has_comment({at_, static_cast<std::size_t>(last - at_)});
    at_ = newline + 1;
    ++line_;
    if (!continued) return;
  }
}

std::string_view TextCursor::word() {
  const char* begin = at_;
  while (at_ != end_ && !ends_number(at_, end_)) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::optional<double> TextCursor::number_if_any() {
  throw_if_interrupted();
  skip_blanks();
  const char* begin = at_;
  if (at_ != end_ && *at_ == '+' && at_ + 1 != end_ && at_[1] != '-') ++begin;
  double value = 0;
  const auto [past, error] = std::from_chars(begin, end_, value);
  if (error == std::errc::invalid_argument || !ends_number(past, end_)) return std::nullopt;
  if (error == std::errc::result_out_of_range) value = round_extreme(begin, past);
  at_ = past;
  return value;
}

double TextCursor::number(const char* what) {
  const std::optional<double> value = number_if_any();
  if (!value) fail_word(what);
  return *value;
}

std::optional<std::int64_t> TextCursor::integer_if_any() {
  throw_if_interrupted();
  skip_blanks();
  const char* begin = at_;
  if (at_ != end_ && *at_ == '+' && at_ + 1 != end_ && at_[1] != '-') ++begin;
  std::int64_t value = 0;
  const auto [past, error] = std::from_chars(begin, end_, value);
  const bool ended = past != end_ && *past == '/' ? true : ends_number(past, end_);
  if (error != std::errc() || !ended) return std::nullopt;
  at_ = past;
  return value;
}

std::uint64_t TextCursor::index(const char* what, std::uint64_t count) {
  const std::int64_t number = integer(what);
  if (number >= 0 && static_cast<std::uint64_t>(number) < count) {
    return static_cast<std::uint64_t>(number);
  }
  fail("there is no " + std::string(what) + " " + std::to_string(number) + ": there are " +
       std::to_string(count) + ", counted from 0");
}

std::int64_t TextCursor::integer(const char* what) {
  const std::optional<std::int64_t> value = integer_if_any();
  if (!value) fail_word(what);
  return *value;
}

void TextCursor::fail_word(const char* what) {
  std::string found(word());
  if (found.empty()) {
    fail(std::string(what) + " is missing: the " + (at_end() ? "file" : "line") + " ends early");
  }
  if (found.size() > 40) found = found.substr(0, 40) + "...";
  fail(std::string(what) + " is not a number: '" + found + "'");
}

void TextCursor::fail(const std::string& message, std::int32_t element_kind,
                      std::uint64_t element) const {
  throw Failure(place() + message, element_kind, element);
}

std::string TextCursor::place() const {
  return path_ + ": line " + std::to_string(line_) + ": ";
}

}  // namespace beltrami::cli
