// Compression by zlib.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace beltrami::cli {

/// Which repetitions are looked for.
enum class Repetitions {
  kOfOneByte,  ///< the gutters and flats of filtered pictures; a search for all took ten times as
               ///< long and made pictures with detail no smaller
  kAll         ///< a quick search
};

/// Bytes in the format of zlib (RFC 1950), of which a part is in memory at once.
class Deflater {
 public:
  using Take = std::function<void(std::string_view)>;

  /// `take` gets what is compressed, some bytes at a time. Throws std::bad_alloc.
  Deflater(Repetitions repetitions, Take take);
  ~Deflater();
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void add(std::string_view bytes);
  /// Call it once, after all else.
  void end();

 private:
  struct Stream;
  void run(std::string_view bytes, bool last);

  std::unique_ptr<Stream> stream_;
  Take take_;
  std::string part_;
};

/// `bytes` in that format. Throws std::bad_alloc.
std::string zlib_bytes(std::string_view bytes, Repetitions repetitions);

/// Of a chunk of PNG, or of its bytes after those whose sum is `before`.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

}  // namespace beltrami::cli
