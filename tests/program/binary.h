// Numbers as the bytes of a binary file.
#pragma once

#include <bit>
#include <cstring>
#include <string>

namespace beltrami::cli {

/// `big`: the first byte is the greatest.
template <class Number>
std::string bytes_of(Number value, bool big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big == (std::endian::native == std::endian::little)) {
    bytes.assign(bytes.rbegin(), bytes.rend());
  }
  return bytes;
}

}  // namespace beltrami::cli
