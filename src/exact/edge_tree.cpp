#include "exact/edge_tree.h"

#include <bit>

namespace beltrami {

EdgeTree::EdgeTree(const ClosedPolygon& polygon)
    : polygon_(polygon),
      leaf_count_(
          static_cast<Index>(std::bit_ceil(static_cast<std::uint32_t>(polygon.edge_count())))) {
  boxes_.resize(2 * static_cast<std::size_t>(leaf_count_));
  for (Index e = 0; e < polygon_.edge_count(); ++e) enclose(e);
  for (Index node = leaf_count_ - 1; node > 0; --node) {
    boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
  }
}

void EdgeTree::update(Index edge) {
  enclose(edge);
  for (Index node = (leaf_count_ + edge) / 2; node > 0; node /= 2) {
    boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
  }
}

void EdgeTree::enclose(Index edge) {
  boxes_[leaf_count_ + edge] = Eigen::AlignedBox2d(polygon_.start(edge));
  boxes_[leaf_count_ + edge].extend(polygon_.end(edge));
}

}  // namespace beltrami
