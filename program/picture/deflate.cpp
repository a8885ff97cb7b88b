#include "picture/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <new>

namespace beltrami::cli {
namespace {

/// Bytes that a call of zlib takes, which counts them in 32 bits.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
constexpr std::size_t kPart = 1 << 20;  ///< of what it gives
constexpr int kWindowBits = 15, kMemoryLevel = 9;

/// Of zlib, which ends with this.
struct Stream {
  z_stream state{};

  explicit Stream(Repetitions repetitions) {
    const int strategy = repetitions == Repetitions::kAll ? Z_DEFAULT_STRATEGY : Z_RLE;
    const int made =
        deflateInit2(&state, Z_BEST_SPEED, Z_DEFLATED, kWindowBits, kMemoryLevel, strategy);
    if (made != Z_OK) throw std::bad_alloc();
  }
  ~Stream() { deflateEnd(&state); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

}  // namespace

std::string zlib_bytes(std::string_view bytes, Repetitions repetitions) {
  Stream stream(repetitions);
  std::string all;
  // zlib reads the bytes alone, though its type does not say so.
  stream.state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  std::size_t left = bytes.size();
  for (int state = Z_OK; state != Z_STREAM_END;) {
    const std::size_t given = std::min(left, kMostAtOnce - stream.state.avail_in);
    stream.state.avail_in += static_cast<uInt>(given);
    left -= given;
    const std::size_t before = all.size();
    all.resize(before + kPart);
    stream.state.next_out = reinterpret_cast<Bytef*>(all.data() + before);
    stream.state.avail_out = static_cast<uInt>(kPart);
    state = deflate(&stream.state, left == 0 ? Z_FINISH : Z_NO_FLUSH);
    all.resize(all.size() - stream.state.avail_out);
  }
  return all;
}

std::uint32_t crc32(std::string_view bytes) {
  uLong sum = ::crc32(0, nullptr, 0);
  for (std::size_t begin = 0; begin < bytes.size(); begin += kMostAtOnce) {
    const std::size_t size = std::min(bytes.size() - begin, kMostAtOnce);
    sum =
        ::crc32(sum, reinterpret_cast<const Bytef*>(bytes.data() + begin), static_cast<uInt>(size));
  }
  return static_cast<std::uint32_t>(sum);
}

}  // namespace beltrami::cli
