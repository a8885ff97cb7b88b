#include "exact/crossings.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "base/interrupt.h"
#include "exact/edge_tree.h"
#include "exact/sweep.h"

namespace beltrami {
namespace {

/// Bounds of a listing: pairs, and boxes looked at per edge and level of the tree.
constexpr std::int64_t kPairsPerEdge = 4, kFewPairs = 65536;
constexpr std::int64_t kBoxesPerEdge = 8, kFewBoxes = 1 << 20;

using Pair = std::array<Index, 2>;

/// Lists pairs within the bounds.
class Listing {
 public:
  explicit Listing(const ClosedPolygon& polygon) : polygon_(polygon), tree_(polygon) {
    const Index count = polygon.edge_count();
    const std::int64_t levels = std::bit_width(static_cast<std::uint32_t>(tree_.leaf_count()));
    boxes_left_ = std::max(kFewBoxes, kBoxesPerEdge * levels * count);
    pairs_left_ = std::max(kFewPairs, kPairsPerEdge * count);
  }

  /// Appends the pairs of `edge` with the edges that it meets, but for later ones that are `listed`
  /// on their own. False if a bound was reached.
  bool list(Index edge, const std::vector<bool>& listed, std::vector<Pair>& pairs) {
    return tree_.for_each_near(
        edge, [&] { return --boxes_left_ >= 0; },
        [&](Index other) {
          const bool later = listed[other] && other > edge;
          if (other == edge || later || !polygon_.meet(edge, other)) return true;
          pairs.push_back({std::min(edge, other), std::max(edge, other)});
          return --pairs_left_ >= 0;
        });
  }

 private:
  const ClosedPolygon& polygon_;
  EdgeTree tree_;
  std::int64_t boxes_left_ = 0, pairs_left_ = 0;
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
  Listing listing(polygon);
  for (const TakenOut& t : taken) {
    if (!listing.list(t.edge, listed, pairs)) break;
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
