// What the targets that call the C interface have in common: a host whose bytes say what it passes.
#pragma once

#include <beltrami/beltrami.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

#include "target.h"

namespace beltrami::fuzz {

using Provider = FuzzedDataProvider;

struct Destroy {
  void operator()(beltrami_context* context) const { beltrami_destroy(context); }
};
using Context = std::unique_ptr<beltrami_context, Destroy>;

inline Context make_context() {
  beltrami_context* context = nullptr;
  promise(beltrami_create(&context) == BELTRAMI_OK, "a context is made");
  return Context(context);
}

/// A progress function that cancels after as many looks as the int `polls` says.
inline std::int32_t count_down(void* polls, double fraction, const char* stage) {
  promise(fraction >= 0 && fraction <= 1, "progress is a share");
  promise(stage != nullptr, "progress has a stage");
  return --*static_cast<int*>(polls) < 0;
}

/// A failure has a sentence, and a success has none.
inline void judge_status(const beltrami_context* context, beltrami_status status) {
  promise(status != BELTRAMI_E_INTERNAL, "no call shows a defect");
  promise(std::string_view(beltrami_status_name(status)) != "unknown", "a status has a name");
  if (context == nullptr) return;
  const bool has_sentence = *beltrami_error_message(context) != '\0';
  promise(has_sentence == (status < BELTRAMI_OK), "failures and nothing else have a sentence");
}

/// A struct of the interface, now and then of a host that was compiled with a shorter one.
template <class Struct>
Struct sized(Provider& data) {
  Struct value{};
  value.struct_size = sizeof value;
  if (data.ConsumeIntegralInRange(0, 31) == 0) {
    value.struct_size = data.ConsumeIntegralInRange<std::uint32_t>(0, sizeof value);
  }
  return value;
}

/// The same, as it is.
template <class Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

/// An array of exactly as many bytes as its items take.
struct Array {
  std::vector<char> bytes;
  beltrami_buffer buffer{};
};

inline bool is_wide(std::int32_t type) {
  return type == BELTRAMI_F64 || type == BELTRAMI_U64;
}

inline double coordinate(Provider& data) {
  if (data.ConsumeIntegralInRange(0, 40) == 0) return data.ConsumeFloatingPoint<double>();
  return data.ConsumeIntegralInRange(-8, 8);
}

inline void store(char* at, std::int32_t type, double number) {
  const auto put = [&](auto value) { std::memcpy(at, &value, sizeof value); };
  if (type == BELTRAMI_F32) put(static_cast<float>(std::clamp(number, -1e30, 1e30)));
  if (type == BELTRAMI_F64) put(number);
  if (type == BELTRAMI_U32) put(static_cast<std::uint32_t>(number));
  if (type == BELTRAMI_U64) put(static_cast<std::uint64_t>(number));
}

/// Bytes from an item to the next that no memory has.
inline constexpr std::uint64_t kWildStride = std::uint64_t{1} << 63;

/// Of a wide or a narrow type, packed or with bytes between items; now and then of a type that is
/// none, or of a stride that cannot be. `number` says what item i has at place k of its width.
template <class Number>
Array array_of(Provider& data, std::size_t items, std::size_t width, bool real,
               const Number& number) {
  Array out;
  const bool wide = data.ConsumeBool();
  const std::int32_t type =
      real ? (wide ? BELTRAMI_F64 : BELTRAMI_F32) : (wide ? BELTRAMI_U64 : BELTRAMI_U32);
  const std::size_t size = is_wide(type) ? 8 : 4;
  const std::size_t gap = data.ConsumeIntegralInRange<std::size_t>(0, 3);
  const std::size_t stride = width * size + gap;
  if (items == 0) return out;
  out.bytes.resize((items - 1) * stride + width * size);
  for (std::size_t i = 0; i < items; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      store(&out.bytes[i * stride + k * size], type, static_cast<double>(number(i, k)));
    }
  }
  out.buffer = {out.bytes.data(), gap == 0 && wide ? 0 : stride, type, 0};
  switch (data.ConsumeIntegralInRange(0, 60)) {
    case 0:
      out.buffer.type = data.ConsumeIntegral<int8_t>();
      break;
    case 1:
      out.buffer.reserved = 1;
      break;
    case 2:
      out.buffer.stride = data.ConsumeBool() ? 1 : kWildStride;
      break;
    default:
      break;
  }
  // A greater type or stride would reach beyond the array: that is the host's word, not checked.
  if (is_wide(out.buffer.type) && !wide) out.buffer.type = type;
  return out;
}

/// Of real numbers, or whole ones up to `limit`.
inline Array array(Provider& data, std::size_t items, std::size_t width, bool real,
                   std::uint32_t limit) {
  return array_of(data, items, width, real, [&](std::size_t, std::size_t) -> double {
    if (real) return coordinate(data);
    return data.ConsumeIntegralInRange<std::uint32_t>(0, limit);
  });
}

/// A view of packed numbers.
inline beltrami_buffer view(const std::vector<double>& numbers) {
  return {numbers.empty() ? nullptr : numbers.data(), 0, BELTRAMI_F64, 0};
}
inline beltrami_buffer view(const std::vector<std::uint32_t>& numbers) {
  return {numbers.empty() ? nullptr : numbers.data(), 0, BELTRAMI_U32, 0};
}

}  // namespace beltrami::fuzz
