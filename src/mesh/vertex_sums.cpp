#include "mesh/vertex_sums.h"

namespace beltrami {

VertexSums::VertexSums(Index vertex_count, const std::vector<Triangle>& faces)
    : faces_(faces),
      shared_(static_cast<std::size_t>(vertex_count), 0),
      aside_(faces.size() / kGrain + 1) {
  std::vector<Index> chunk_of(shared_.size(), kNone);
  for (Index f = 0; f < size_of(faces); ++f) {
    const auto chunk = static_cast<Index>(f / kGrain);
    for (const Index v : faces[f]) {
      if (chunk_of[v] != chunk && chunk_of[v] != kNone) shared_[v] = 1;
      chunk_of[v] = chunk;
    }
  }
}

}  // namespace beltrami
