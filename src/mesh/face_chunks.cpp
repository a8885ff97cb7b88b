#include "mesh/face_chunks.h"

#include <atomic>

#include "base/parallel.h"
#include "base/scratch.h"

namespace beltrami {

FaceChunks::FaceChunks(Index vertex_count, const std::vector<Triangle>& faces, const Work& work)
    : grain_(grain_of(size_of(faces))),
      count_(of(size_of(faces)) + 1),
      shared_(static_cast<std::size_t>(vertex_count), 0) {
  if (count_ == 1) return;
  // Whichever chunk comes last at a vertex: the others find its mark.
  Scratch<Index> last_chunk(work, shared_.size());
  parallel_for(work, size_of(faces), grain_, [&](std::int64_t begin, std::int64_t end) {
    const auto chunk = static_cast<Index>(of(begin));
    for (std::int64_t f = begin; f < end; ++f) {
      for (const Index v : faces[f]) {
        std::atomic_ref<Index>(last_chunk[v]).store(chunk, std::memory_order_relaxed);
      }
    }
  });
  parallel_for(work, size_of(faces), grain_, [&](std::int64_t begin, std::int64_t end) {
    const auto chunk = static_cast<Index>(of(begin));
    for (std::int64_t f = begin; f < end; ++f) {
      for (const Index v : faces[f]) {
        const std::atomic_ref<Index> last(last_chunk[v]);
        if (last.load(std::memory_order_relaxed) == chunk) continue;
        std::atomic_ref<std::uint8_t>(shared_[v]).store(1, std::memory_order_relaxed);
      }
    }
  });
}

}  // namespace beltrami
