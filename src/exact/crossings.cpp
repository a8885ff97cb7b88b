#include "exact/crossings.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "base/interrupt.h"
#include "exact/polygon.h"
#include "exact/sweep.h"

namespace beltrami {
namespace {

/// Bounds of a listing: pairs, and boxes looked at per edge and level of the tree.
constexpr std::int64_t kPairsPerEdge = 4, kFewPairs = 65536;
constexpr std::int64_t kBoxesPerEdge = 8, kFewBoxes = 1 << 20;

using Pair = std::array<Index, 2>;
using Box = Eigen::AlignedBox2d;

/// A binary tree of bounding boxes over the consecutive edges of a closed polygon. Edges that are
/// near in the loop are near in the plane, so the loop order is a good hierarchy as it stands.
class EdgeTree {
 public:
  explicit EdgeTree(const ClosedPolygon& polygon) : polygon_(polygon) {
    const Index count = polygon.edge_count();
    leaf_count_ = static_cast<Index>(std::bit_ceil(static_cast<std::uint32_t>(count)));
    boxes_.resize(2 * static_cast<std::size_t>(leaf_count_));
    for (Index e = 0; e < count; ++e) {
      boxes_[leaf_count_ + e].extend(polygon.start(e));
      boxes_[leaf_count_ + e].extend(polygon.end(e));
    }
    for (Index node = leaf_count_ - 1; node > 0; --node) {
      boxes_[node] = boxes_[2 * node].merged(boxes_[2 * node + 1]);
    }
    const std::int64_t levels = std::bit_width(static_cast<std::uint32_t>(leaf_count_));
    boxes_left_ = std::max(kFewBoxes, kBoxesPerEdge * levels * count);
    pairs_left_ = std::max(kFewPairs, kPairsPerEdge * count);
  }

  /// Appends the pairs of `edge` with the edges that it meets, but for later ones that are `listed`
  /// on their own. False if a bound was reached.
  bool list(Index edge, const std::vector<bool>& listed, std::vector<Pair>& pairs) {
    stack_.assign(1, 1);
    while (!stack_.empty()) {
      const Index node = stack_.back();
      stack_.pop_back();
      poll_();
      if (--boxes_left_ < 0) return false;
      if (!boxes_[node].intersects(boxes_[leaf_count_ + edge])) continue;
      if (node < leaf_count_) {
        stack_.push_back(2 * node + 1);
        stack_.push_back(2 * node);
        continue;
      }
      const Index other = node - leaf_count_;
      if (other == edge || (listed[other] && other > edge) || !polygon_.meet(edge, other)) continue;
      if (--pairs_left_ < 0) return false;
      pairs.push_back({std::min(edge, other), std::max(edge, other)});
    }
    return true;
  }

 private:
  const ClosedPolygon& polygon_;
  Index leaf_count_ = 1;
  std::vector<Box> boxes_;
  std::vector<Index> stack_;
  std::int64_t boxes_left_ = 0, pairs_left_ = 0;
  PollSometimes poll_;
};

}  // namespace

bool is_simple(const std::vector<Index>& loop, const std::vector<Vec2>& uvs) {
  return take_out_meeting_edges(ClosedPolygon(loop, uvs), 1).empty();
}

std::vector<Pair> find_crossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs) {
  const ClosedPolygon polygon(loop, uvs);
  const std::vector<TakenOut> taken = take_out_meeting_edges(polygon, size_of(loop));
  std::vector<Pair> pairs;
  if (taken.empty()) return pairs;
  // Without these edges none meet: each pair has one of them.
  std::vector<bool> listed(loop.size(), false);
  for (const TakenOut& t : taken) {
    listed[t.edge] = true;
    pairs.push_back({std::min(t.edge, t.because_of), std::max(t.edge, t.because_of)});
  }
  EdgeTree tree(polygon);
  for (const TakenOut& t : taken) {
    if (!tree.list(t.edge, listed, pairs)) break;
  }
  sort_interruptibly(pairs.begin(), pairs.end(), std::less<>());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Crossings count_crossings(const std::vector<Index>& loop, const std::vector<Vec2>& uvs) {
  const std::vector<Pair> pairs = find_crossings(loop, uvs);
  Crossings crossings{static_cast<std::int64_t>(pairs.size()), {kNone, kNone}};
  if (!pairs.empty()) crossings.first_pair = {loop[pairs[0][0]], loop[pairs[0][1]]};
  return crossings;
}

}  // namespace beltrami
