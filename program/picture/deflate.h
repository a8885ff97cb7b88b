// Compression of pictures, fast.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// `bytes` in the format of zlib (RFC 1950): Huffman codes for each block, and repetitions of the
/// byte before alone, which the gutters and flats of filtered pictures are. A general search for
/// repetitions took ten times as long and made pictures with detail no smaller.
std::string zlib_bytes(std::string_view bytes);

/// Of a chunk of PNG.
std::uint32_t crc32(std::string_view bytes);

}  // namespace beltrami::cli
