#include "exact/crossings.h"

#include <algorithm>
#include <functional>

#include "base/interrupt.h"
#include "exact/box_tree.h"
#include "exact/edge_tree.h"
#include "exact/polygon.h"
#include "exact/sweep.h"

namespace beltrami {
namespace {

using Pair = std::array<Index, 2>;

/// Lists pairs within the bounds.
class Listing {
 public:
  explicit Listing(const ClosedPolygon& polygon)
      : polygon_(polygon), tree_(polygon), bounds_(polygon.edge_count()) {}

  /// Appends the pairs of `edge` with the edges that it meets, but for later ones that are `listed`
  /// on their own. False if a bound was reached.
  bool list(Index edge, const std::vector<bool>& listed, std::vector<Pair>& pairs) {
    return tree_.for_each_near(
        edge, [&] { return bounds_.look(); },
        [&](Index other) {
          const bool later = listed[other] && other > edge;
          if (other == edge || later || !polygon_.meet(edge, other)) return true;
          pairs.push_back({std::min(edge, other), std::max(edge, other)});
          return bounds_.pair();
        });
  }

 private:
  const ClosedPolygon& polygon_;
  EdgeTree tree_;
  ListingBounds bounds_;
};

}  // namespace

bool is_simple(const std::vector<Index>& loop, const std::vector<Vec2>& uvs) {
  const ClosedPolygon polygon(loop, uvs);
  ListingBounds bounds(polygon.edge_count());
  bool meet = false;
  const bool all = EdgeTree(polygon).for_each_pair([&] { return bounds.look(); },
                                                   [&](Index e, Index f) {
                                                     meet = polygon.meet(e, f);
                                                     return !meet;
                                                   });
  // Where too many boxes meet, the sweep: it takes longer on others, but not on these.
  return all || (!meet && take_out_meeting_edges(polygon, 1).empty());
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
