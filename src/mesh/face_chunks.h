// Fixed chunks of faces, for sums at vertices that are made in parallel.
#pragma once

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
  static constexpr std::int64_t kGrain = 8192;

  FaceChunks(Index vertex_count, const std::vector<Triangle>& faces, const Work& work);

  std::size_t count() const { return count_; }
  static std::size_t of(std::int64_t face) { return static_cast<std::size_t>(face / kGrain); }
  /// Whether faces of several chunks touch the vertex.
  bool shared(Index v) const { return shared_[v] != 0; }

 private:
  std::size_t count_;
  std::vector<std::uint8_t> shared_;
};

}  // namespace beltrami
