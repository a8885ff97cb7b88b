// Compression by zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// Which repetitions are looked for.
enum class Repetitions {
  kOfOneByte,  ///< the gutters and flats of filtered pictures; a search for all took ten times as
               ///< long and made pictures with detail no smaller
  kAll         ///< a quick search
};

/// `bytes` in the format of zlib (RFC 1950). Throws std::bad_alloc.
std::string zlib_bytes(std::string_view bytes, Repetitions repetitions = Repetitions::kOfOneByte);

/// Of a chunk of PNG.
std::uint32_t crc32(std::string_view bytes);

}  // namespace beltrami::cli
