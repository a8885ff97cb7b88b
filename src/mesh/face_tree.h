// A bounding volume hierarchy over the faces of a mesh, in flat arrays.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// Boxes within boxes, whose leaves hold a few faces each. Halves by count: a way from the root to
/// a leaf has 32 nodes at most.
struct FaceTree {
  struct Node {
    Eigen::AlignedBox3d box;
    Index first = 0;  ///< first face in `order` of a leaf; left child of an inner node
    Index count = 0;  ///< faces of a leaf; 0 for an inner node, whose right child is first + 1
  };
  /// Entries that a search from the root may have to keep, two for each level.
  static constexpr std::size_t kMostEntries = 64;

  std::vector<Node> nodes;   ///< the root first
  std::vector<Index> order;  ///< all faces, those of a leaf side by side

  /// Of one face or more, all finite. Polls.
  FaceTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces);
};

}  // namespace beltrami
