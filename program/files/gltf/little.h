// Numbers as glTF has them in its buffers: little endian.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace beltrami::cli::gltf {

/// The number at `bytes`, which need not be aligned.
template <class Number>
Number little(const char* bytes) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if constexpr (std::endian::native == std::endian::big) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

template <class Number>
void append_little(std::string& bytes, Number value) {
  auto copy = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(copy.begin(), copy.end());
  bytes.append(copy.data(), copy.size());
}

}  // namespace beltrami::cli::gltf
