// Fixed chunks of faces, for sums at vertices that are made in parallel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
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
    constexpr std::int64_t kLeast = 256, kMost = 8192, kChunks = 16;
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

/// What the chunks put aside for shared vertices: per chunk and run of vertices, so that the runs
/// can be added up side by side.
template <class Item>
class PutAside {
 public:
  PutAside(const FaceChunks& chunks, Index vertex_count)
      : run_length_(vertex_count / kRuns + 1), of_chunk_(chunks.count()) {}

  /// Makes room for what a chunk puts aside anew.
  void clear(std::size_t chunk) {
    for (std::vector<Item>& run : of_chunk_[chunk]) run.clear();
  }

  void put(std::size_t chunk, Index vertex, const Item& item) {
    of_chunk_[chunk][vertex / run_length_].push_back(item);
  }

  /// Calls add(item) for all of them; those of a vertex in the order of the chunks.
  template <class Add>
  void add_up(const Work& work, const Add& add) const {
    if (of_chunk_.size() == 1) return;
    parallel_for(work, kRuns, 1, [&](std::int64_t run, std::int64_t) {
      for (const auto& runs : of_chunk_) {
        for (const Item& item : runs[run]) add(item);
      }
    });
  }

 private:
  static constexpr Index kRuns = 16;

  Index run_length_;
  std::vector<std::array<std::vector<Item>, kRuns>> of_chunk_;
};

}  // namespace beltrami
