#include "files/column.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace beltrami::cli {
namespace {

struct Names {
  std::string_view common, sized;
};
constexpr std::array<Names, 8> kNames = {{{"char", "int8"},
                                          {"uchar", "uint8"},
                                          {"short", "int16"},
                                          {"ushort", "uint16"},
                                          {"int", "int32"},
                                          {"uint", "uint32"},
                                          {"float", "float32"},
                                          {"double", "float64"}}};

template <class Number>
double decode_as(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

template <class Number>
void append_as(double value, std::vector<char>& bytes) {
  const auto number = static_cast<Number>(value);
  std::array<char, sizeof number> raw;
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

template <class Integer>
bool fits_integer(double value) {
  // NaN fails too.
  return value >= static_cast<double>(std::numeric_limits<Integer>::min()) &&
         value <= static_cast<double>(std::numeric_limits<Integer>::max()) &&
         value == std::floor(value);
}

bool fits(Scalar type, double value) {
  switch (type) {
    case Scalar::kI8:
      return fits_integer<std::int8_t>(value);
    case Scalar::kU8:
      return fits_integer<std::uint8_t>(value);
    case Scalar::kI16:
      return fits_integer<std::int16_t>(value);
    case Scalar::kU16:
      return fits_integer<std::uint16_t>(value);
    case Scalar::kI32:
      return fits_integer<std::int32_t>(value);
    case Scalar::kU32:
      return fits_integer<std::uint32_t>(value);
    case Scalar::kF32:
      return !std::isfinite(value) || std::abs(value) <= std::numeric_limits<float>::max();
    default:
      return true;
  }
}

}  // namespace

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::string_view name_of(Scalar type) {
  return kNames[static_cast<std::size_t>(type)].common;
}

std::optional<Scalar> scalar_named(std::string_view word) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (word == kNames[i].common || word == kNames[i].sized) return static_cast<Scalar>(i);
  }
  return std::nullopt;
}

double decode(Scalar type, const char* bytes) {
  switch (type) {
    case Scalar::kI8:
      return decode_as<std::int8_t>(bytes);
    case Scalar::kU8:
      return decode_as<std::uint8_t>(bytes);
    case Scalar::kI16:
      return decode_as<std::int16_t>(bytes);
    case Scalar::kU16:
      return decode_as<std::uint16_t>(bytes);
    case Scalar::kI32:
      return decode_as<std::int32_t>(bytes);
    case Scalar::kU32:
      return decode_as<std::uint32_t>(bytes);
    case Scalar::kF32:
      return decode_as<float>(bytes);
    default:
      return decode_as<double>(bytes);
  }
}

void Column::append(double value) {
  if (!fits(type_, value)) make_double();
  store(value);
}

void Column::store(double value) {
  switch (type_) {
    case Scalar::kI8:
      return append_as<std::int8_t>(value, bytes_);
    case Scalar::kU8:
      return append_as<std::uint8_t>(value, bytes_);
    case Scalar::kI16:
      return append_as<std::int16_t>(value, bytes_);
    case Scalar::kU16:
      return append_as<std::uint16_t>(value, bytes_);
    case Scalar::kI32:
      return append_as<std::int32_t>(value, bytes_);
    case Scalar::kU32:
      return append_as<std::uint32_t>(value, bytes_);
    case Scalar::kF32:
      return append_as<float>(value, bytes_);
    default:
      return append_as<double>(value, bytes_);
  }
}

void Column::make_double() {
  Column wide(name_, Scalar::kF64, is_list_);
  for (std::uint64_t i = 0; i < size(); ++i) wide.store((*this)[i]);
  bytes_ = std::move(wide.bytes_);
  type_ = Scalar::kF64;
}

const Column* find_column(const std::vector<Column>& columns, std::string_view name) {
  for (const Column& column : columns) {
    if (column.name() == name && !column.is_list()) return &column;
  }
  return nullptr;
}

}  // namespace beltrami::cli
