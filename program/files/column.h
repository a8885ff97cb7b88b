// Attributes of a file's vertices, faces or other items: kept in the type that the file declares,
// for the file that is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beltrami::cli {

/// The number types of PLY. Every value of theirs fits a double without loss.
enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

std::size_t size_of(Scalar type);
/// As PLY calls it: "uchar".
std::string_view name_of(Scalar type);
/// Knows "uchar" and "uint8"; nothing for other words.
std::optional<Scalar> scalar_named(std::string_view word);
/// The value at `bytes`, in the byte order of this machine. No alignment is required.
double decode(Scalar type, const char* bytes);

/// One value, or one list of values, per item.
class Column {
 public:
  Column(std::string name, Scalar type, bool is_list = false)
      : name_(std::move(name)), type_(type), is_list_(is_list) {}

  const std::string& name() const { return name_; }
  Scalar type() const { return type_; }
  bool is_list() const { return is_list_; }

  /// The next value. One that the type cannot hold makes the whole column double.
  void append(double value);
  /// Ends the list of an item, which may be empty.
  void end_list() { ends_.push_back(size()); }

  /// Values in all.
  std::uint64_t size() const { return bytes_.size() / size_of(type_); }
  /// Of a scalar column, the value of item i; else the value with this number in all.
  double operator[](std::uint64_t i) const { return decode(type_, &bytes_[i * size_of(type_)]); }
  /// The bytes of value i, in the byte order of this machine.
  std::string_view bytes(std::uint64_t i) const {
    return {&bytes_[i * size_of(type_)], size_of(type_)};
  }
  /// The values of item i are those in [begin, end).
  std::uint64_t begin(std::uint64_t i) const { return !is_list_ ? i : i == 0 ? 0 : ends_[i - 1]; }
  std::uint64_t end(std::uint64_t i) const { return is_list_ ? ends_[i] : i + 1; }

 private:
  void store(double value);
  void make_double();

  std::string name_;
  Scalar type_;
  bool is_list_;
  std::vector<char> bytes_;
  std::vector<std::uint64_t> ends_;  ///< of lists
};

/// The items of a column at these places.
Column picked(const Column& column, const std::vector<std::uint64_t>& places);

/// Items that are neither vertices nor faces.
struct Table {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Column> columns;
};

/// The scalar column called `name`, or null.
const Column* find_column(const std::vector<Column>& columns, std::string_view name);

}  // namespace beltrami::cli
