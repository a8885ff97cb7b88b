// Compression of pictures by zlib.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// `bytes` in the format of zlib (RFC 1950), with repetitions of the byte before alone: the gutters
/// and flats of filtered pictures are such. A general search for repetitions took ten times as long
/// and made pictures with detail no smaller. Throws std::bad_alloc.
std::string zlib_bytes(std::string_view bytes);

/// Of a chunk of PNG.
std::uint32_t crc32(std::string_view bytes);

}  // namespace beltrami::cli
