#include "picture/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>

#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// Bytes that a call of zlib takes: some milliseconds of work, after which a request to end is
/// heard.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 18;
constexpr std::size_t kPart = std::size_t{1} << 18;  ///< of what it gives
constexpr int kWindowBits = 15, kMemoryLevel = 9;

}  // namespace

/// Of zlib, which ends with this.
struct Deflater::Stream {
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

Deflater::Deflater(Repetitions repetitions, Take take)
    : stream_(std::make_unique<Stream>(repetitions)), take_(std::move(take)), part_(kPart, 0) {
  stream_->state.avail_out = static_cast<uInt>(kPart);
}

Deflater::~Deflater() = default;

void Deflater::add(std::string_view bytes) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kMostAtOnce))) {
    throw_if_interrupted();
    run(bytes.substr(0, kMostAtOnce), false);
  }
}

void Deflater::end() {
  run({}, true);
  const std::size_t left = kPart - stream_->state.avail_out;
  if (left > 0) take_(std::string_view(part_).substr(0, left));
}

void Deflater::run(std::string_view bytes, bool last) {
  z_stream& state = stream_->state;
  // zlib reads the bytes alone, though its type does not say so.
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  state.avail_in = static_cast<uInt>(bytes.size());
  for (int done = Z_OK; last ? done != Z_STREAM_END : state.avail_in > 0;) {
    state.next_out = reinterpret_cast<Bytef*>(part_.data() + (kPart - state.avail_out));
    done = deflate(&state, last ? Z_FINISH : Z_NO_FLUSH);
    if (state.avail_out > 0) continue;
    take_(part_);
    state.avail_out = static_cast<uInt>(kPart);
  }
}

std::string zlib_bytes(std::string_view bytes, Repetitions repetitions) {
  std::string all;
  Deflater deflater(repetitions, [&](std::string_view part) { all += part; });
  deflater.add(bytes);
  deflater.end();
  return all;
}

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  uLong sum = before;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kMostAtOnce))) {
    const std::string_view part = bytes.substr(0, kMostAtOnce);
    sum = ::crc32(sum, reinterpret_cast<const Bytef*>(part.data()), static_cast<uInt>(part.size()));
  }
  return static_cast<std::uint32_t>(sum);
}

}  // namespace beltrami::cli
