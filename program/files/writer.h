// Collects the small pieces of a file into blocks.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// Numbers in text come from std::to_chars in its shortest form: at most 17 digits, and the same
/// bits when read back by a reader that rounds correctly. Numbers in binary are little endian.
class Writer {
 public:
  explicit Writer(const Sink& sink) : sink_(sink) { block_.reserve(kBlock + 256); }

  void text(std::string_view text) {
    block_.append(text);
    if (block_.size() >= kBlock) flush();
  }

  template <class Number>
  void number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  template <class Number>
  void binary(Number value) {
    std::array<char, sizeof value> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    binary(std::string_view(bytes.data(), bytes.size()));
  }
  /// The bytes of one number in the order of this machine.
  void binary(std::string_view native) {
    if constexpr (std::endian::native == std::endian::little) {
      text(native);
    } else {
      text(std::string(native.rbegin(), native.rend()));
    }
  }

  void flush() {
    sink_(block_);
    block_.clear();
  }

 private:
  static constexpr std::size_t kBlock = 1 << 20;
  const Sink& sink_;
  std::string block_;
};

}  // namespace beltrami::cli
