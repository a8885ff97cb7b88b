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

/// Calls body(number) with a number of the type: the one place that knows them all.
template <class Body>
auto with_number(Scalar type, const Body& body) {
  switch (type) {
    case Scalar::kI8:
      return body(std::int8_t{});
    case Scalar::kU8:
      return body(std::uint8_t{});
    case Scalar::kI16:
      return body(std::int16_t{});
    case Scalar::kU16:
      return body(std::uint16_t{});
    case Scalar::kI32:
      return body(std::int32_t{});
    case Scalar::kU32:
      return body(std::uint32_t{});
    case Scalar::kF32:
      return body(float{});
    default:
      return body(double{});
  }
}

bool fits(Scalar type, double value) {
  return with_number(type, [&]<class Number>(Number) {
    using Limits = std::numeric_limits<Number>;
    const bool in_range = value >= static_cast<double>(Limits::lowest()) &&
                          value <= static_cast<double>(Limits::max());  // NaN is not
    return Limits::is_integer ? in_range && value == std::floor(value)
                              : in_range || !std::isfinite(value);
  });
}

}  // namespace

std::size_t size_of(Scalar type) {
  return with_number(type, [](auto number) { return sizeof number; });
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
  return with_number(type, [&](auto number) {
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
  });
}

void Column::append(double value) {
  if (!fits(type_, value)) make_double();
  store(value);
}

void Column::store(double value) {
  with_number(type_, [&]<class Number>(Number) {
    const auto number = static_cast<Number>(value);
    std::array<char, sizeof number> raw;
    std::memcpy(raw.data(), &number, sizeof number);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  });
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

Column picked(const Column& column, const std::vector<std::uint64_t>& places) {
  Column result(column.name(), column.type(), column.is_list());
  for (const std::uint64_t place : places) {
    for (std::uint64_t i = column.begin(place); i < column.end(place); ++i) {
      result.append(column[i]);
    }
    if (column.is_list()) result.end_list();
  }
  return result;
}

}  // namespace beltrami::cli
