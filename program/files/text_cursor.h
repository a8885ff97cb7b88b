// Walks through the text of a mesh file: words and numbers, with the line for error messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// Words are separated by blanks; a carriage return is a blank, so that CRLF needs no other care.
/// With continuations, a backslash before a line end is a blank too (OBJ). Whatever moves over
/// words, numbers or lines throws the Failure of a cancelled command where interrupted().
class TextCursor {
 public:
  /// `text` and `path` must outlive the cursor.
  TextCursor(std::string_view text, const std::string& path, bool continuations = false)
      : at_(text.data()),
        end_(text.data() + text.size()),
        path_(path),
        continuations_(continuations) {}

  bool at_end() const { return at_ == end_; }
  const char* position() const { return at_; }
  std::uint64_t line() const { return line_; }
  void set_line(std::uint64_t line) { line_ = line; }

  /// The character here, or 0 at the end.
  char peek() const { return at_ == end_ ? '\0' : *at_; }
  void advance() { ++at_; }

  /// Passes over blanks of this (continued) line. A comment counts as the end of the line.
  void skip_blanks() {
    while (at_ != end_) {
      const char c = *at_;
      if (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f') {
        ++at_;
      } else if (c != '\\' || !continuations_ || !skip_continuation()) {
        return;
      }
    }
  }

  /// After skip_blanks: whether nothing is left on this line.
  bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '#'; }

  /// Goes to the start of the next line, over continued ones.
  void skip_line();

  /// Passes over blanks, line ends and comments, to the next word of the file.
  void skip_to_word() {
    for (;;) {
      skip_blanks();
      if (at_ == end_ || !at_line_end()) return;
      skip_line();
    }
  }

  /// The word here: up to a blank or line end. Empty at the end of a line.
  std::string_view word();

  /// The number here, correctly rounded; too great a one is infinite. `what` is for the message.
  double number(const char* what);
  /// The same; where no number stands here, nothing, and the cursor is before what does.
  std::optional<double> number_if_any();

  /// The whole number here. It ends at a blank, a line end or a slash.
  std::int64_t integer(const char* what);
  /// The same; where none stands here, nothing, and the cursor is before what does.
  std::optional<std::int64_t> integer_if_any();
  /// The number here of one of `count` items, which count from 0.
  std::uint64_t index(const char* what, std::uint64_t count);

  /// "path: line n: ", the start of messages.
  std::string place() const;

  /// Throws Failure place() + message.
  [[noreturn]] void fail(const std::string& message, std::int32_t element_kind = 0,
                         std::uint64_t element = UINT64_MAX) const;

 private:
  bool skip_continuation();
  [[noreturn]] void fail_word(const char* what);

  const char* at_;
  const char* end_;
  const std::string& path_;
  bool continuations_;
  std::uint64_t line_ = 1;
};

}  // namespace beltrami::cli
