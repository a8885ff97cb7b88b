#include "mesh/face_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "base/interrupt.h"

namespace beltrami {
namespace {

constexpr Index kLeafFaces = 4;

class TreeBuilder {
 public:
  TreeBuilder(FaceTree& tree, const std::vector<Vec3>& positions,
              const std::vector<Triangle>& faces)
      : tree_(tree), positions_(positions), faces_(faces), centroids_(faces.size()) {
    for (Index f = 0; f < size_of(faces); ++f) {
      const auto& [a, b, c] = faces[f];
      centroids_[f] = (positions[a] + positions[b] + positions[c]) / 3;
    }
  }

  void build(Index node, Index begin, Index end) {
    std::vector<Index>& order = tree_.order;
    Eigen::AlignedBox3d box, centres;
    for (Index i = begin; i < end; ++i) {
      for (const Index v : faces_[order[i]]) box.extend(positions_[v]);
      centres.extend(centroids_[order[i]]);
    }
    tree_.nodes[node].box = box;
    if (end - begin <= kLeafFaces) {
      tree_.nodes[node].first = begin;
      tree_.nodes[node].count = end - begin;
      return;
    }
    poll_interrupt();
    Eigen::Index axis;
    centres.sizes().maxCoeff(&axis);
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](Index f, Index g) {
                       const double a = centroids_[f][axis], b = centroids_[g][axis];
                       return a < b || (a == b && f < g);
                     });
    const Index left = size_of(tree_.nodes);
    tree_.nodes[node].first = left;
    tree_.nodes.resize(tree_.nodes.size() + 2);
    build(left, begin, middle);
    build(left + 1, middle, end);
  }

 private:
  FaceTree& tree_;
  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& faces_;
  std::vector<Vec3> centroids_;
};

}  // namespace

FaceTree::FaceTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces)
    : order(faces.size()) {
  std::iota(order.begin(), order.end(), 0);
  nodes.reserve(2 * faces.size());
  nodes.emplace_back();
  TreeBuilder(*this, positions, faces).build(0, 0, size_of(faces));
}

}  // namespace beltrami
