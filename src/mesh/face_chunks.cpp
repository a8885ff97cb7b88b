#include "mesh/face_chunks.h"

namespace beltrami {

FaceChunks::FaceChunks(Index vertex_count, const std::vector<Triangle>& faces)
    : count_(of(size_of(faces)) + 1), shared_(static_cast<std::size_t>(vertex_count), 0) {
  if (count_ == 1) return;
  std::vector<Index> chunk_of(shared_.size(), kNone);
  for (Index f = 0; f < size_of(faces); ++f) {
    const auto chunk = static_cast<Index>(of(f));
    for (const Index v : faces[f]) {
      if (chunk_of[v] != chunk && chunk_of[v] != kNone) shared_[v] = 1;
      chunk_of[v] = chunk;
    }
  }
}

}  // namespace beltrami
