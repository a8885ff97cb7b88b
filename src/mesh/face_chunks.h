// Fixed chunks of faces, for sums at vertices that are made in parallel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Faces in chunks that do not depend on the number of threads, so that sums have the same bits at
/// any: a chunk adds to the vertices that no other one touches, and puts aside what it has for
/// those that are shared. Those are few where faces that are close in the list are close on the
/// surface.
class FaceChunks {
 public:
  /// Of a chunk: small meshes are parted, too, but not into less than is worth a thread.
  static std::int64_t grain_of(std::int64_t faces) {
    constexpr std::int64_t kLeast = 512, kMost = 8192, kChunks = 16;
    return std::clamp((faces + kChunks - 1) / kChunks, kLeast, kMost);
  }

  FaceChunks(Index vertex_count, const std::vector<Triangle>& faces, const Work& work);

  std::size_t count() const { return count_; }
  std::int64_t grain() const { return grain_; }
  std::size_t of(std::int64_t face) const { return static_cast<std::size_t>(face / grain_); }
  /// Whether faces of several chunks touch the vertex.
  bool shared(Index v) const { return shared_[v] != 0; }

 private:
  std::int64_t grain_;
  std::size_t count_;
  std::vector<std::uint8_t> shared_;
};

}  // namespace beltrami
