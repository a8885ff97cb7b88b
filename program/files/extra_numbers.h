// The numbers that follow the coordinates of a vertex in text: as many as each line has.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files/column.h"
#include "files/text_cursor.h"

namespace beltrami::cli {

/// Rows of up to kWidth numbers, NaN where a row has fewer. Nothing is stored before a row has any.
class ExtraNumbers {
 public:
  static constexpr std::size_t kWidth = 9;

  /// Reads the rest of the line as row `row` (rows come in order); what comes after kWidth numbers
  /// or something else is left on it. Returns whether something is.
  bool read(TextCursor& cursor, std::uint64_t row) {
    std::array<double, kWidth> numbers;
    std::size_t count = 0;
    cursor.skip_blanks();
    while (count < kWidth && !cursor.at_line_end()) {
      const std::optional<double> number = cursor.number_if_any();
      if (!number) break;
      numbers[count++] = *number;
      cursor.skip_blanks();
    }
    add(row, std::span(numbers).first(count));
    return !cursor.at_line_end();
  }

  /// Numbers of the longest row.
  std::size_t width() const { return width_; }

  /// `scale` times number k of each of `rows` rows; k < width().
  Column column(std::size_t k, const std::string& name, std::uint64_t rows,
                double scale = 1) const {
    Column column(name, Scalar::kF64);
    for (std::uint64_t row = 0; row < rows; ++row) {
      const std::size_t at = row * width_ + k;
      const bool known = at < values_.size();
      column.append(known ? scale * values_[at] : std::numeric_limits<double>::quiet_NaN());
    }
    return column;
  }
  /// Whether one of the numbers from k on exceeds 1.
  bool exceeds_one(std::size_t k) const {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (i % width_ >= k && values_[i] > 1) return true;
    }
    return false;
  }

  /// The numbers of row `row`, up to kWidth; rows come in order.
  void add(std::uint64_t row, std::span<const double> numbers) {
    if (numbers.empty()) return;
    if (numbers.size() > width_) widen(numbers.size());
    values_.resize(row * width_, std::numeric_limits<double>::quiet_NaN());
    values_.insert(values_.end(), numbers.begin(), numbers.end());
    values_.resize((row + 1) * width_, std::numeric_limits<double>::quiet_NaN());
  }

 private:
  void widen(std::size_t width) {
    std::vector<double> wide;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      wide.push_back(values_[i]);
      if ((i + 1) % width_ == 0) {
        wide.resize(wide.size() + width - width_, std::numeric_limits<double>::quiet_NaN());
      }
    }
    values_ = std::move(wide);
    width_ = width;
  }

  std::size_t width_ = 0;
  std::vector<double> values_;
};

}  // namespace beltrami::cli
