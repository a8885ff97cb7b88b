#include "exact/sweep.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "exact/line_order.h"

namespace beltrami {
namespace {

/// Invariant: of the edges on the line no two meet at or before it, and no two neighbours on it
/// meet anywhere. Hence their order along the line is the same all the way.
class Sweep {
 public:
  Sweep(const ClosedPolygon& polygon, Index most) : polygon_(polygon), most_(most) {}

  std::vector<TakenOut> run() {
    const Index count = polygon_.edge_count();
    out_.assign(count, false);
    place_.assign(count, on_line_.end());
    segments_.reserve(count);
    for (Index e = 0; e < count; ++e) {
      segments_.push_back(segment_between(polygon_.start(e), polygon_.end(e)));
    }
    take_out_folds();
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    sort_interruptibly(order.begin(), order.end(), [&](Index i, Index j) {
      const Vec2 &a = polygon_.start(i), &b = polygon_.start(j);
      return is_before(a, b) || (a == b && i < j);
    });
    for (Index from = 0, until = 0; from < count && !enough(); from = until) {
      const Vec2& here = polygon_.start(order[from]);
      while (until < count && polygon_.start(order[until]) == here) ++until;
      // Beginnings before ends, so that edges are seen to meet that only touch there.
      for (Index i = from; i < until; ++i) visit(order[i], here, true);
      for (Index i = from; i < until; ++i) visit(order[i], here, false);
    }
    return std::move(found_);
  }

 private:
  using Line = std::set<Index, LineOrder>;

  const Vec2& left(Index e) const { return segments_[e].left; }
  int side(Index e, const Vec2& p) const { return order_.side(e, p); }

  bool enough() const { return size_of(found_) >= most_; }

  void take_out(Index edge, Index because_of) {
    out_[edge] = true;
    if (!enough()) found_.push_back({edge, because_of});
  }

  /// Neighbours that overlap, and edges without length, which have no place on the line.
  void take_out_folds() {
    for (Index e = 0; e < polygon_.edge_count() && !enough(); ++e) {
      poll_();
      const Index next = polygon_.next(e);
      const bool empty = polygon_.start(e) == polygon_.end(e);
      if (empty) {
        if (!out_[e]) take_out(e, next);
      } else if (!out_[e] && !out_[next] && polygon_.folds_back_after(e)) {
        take_out(next, e);
      }
    }
  }

  /// The edges of vertex `i` that begin, or those that end, at its place.
  void visit(Index i, const Vec2& here, bool beginnings) {
    for (const Index e : {polygon_.previous(i), i}) {
      if (out_[e] || enough()) continue;
      if (beginnings == (left(e) == here)) beginnings ? begin(e) : end(e);
    }
  }

  /// Puts an edge on the line, unless it meets one there.
  void begin(Index e) {
    const Vec2& here = left(e);
    // An earlier edge through the place must be the neighbour that it shares with it.
    for (auto at = on_line_.lower_bound(here); at != on_line_.end() && side(*at, here) == 0; ++at) {
      if (!polygon_.neighbours(*at, e)) return take_out(e, *at);
    }
    const auto at = on_line_.insert(e).first;
    const auto above = std::next(at);
    for (const auto& beside : {at == on_line_.begin() ? on_line_.end() : std::prev(at), above}) {
      if (beside == on_line_.end() || !polygon_.meet(*beside, e)) continue;
      const Index because_of = *beside;
      on_line_.erase(at);
      return take_out(e, because_of);
    }
    place_[e] = at;
  }

  /// Takes an edge off the line; those beside it may meet each other.
  void end(Index e) {
    auto above = on_line_.erase(place_[e]);
    while (above != on_line_.begin() && above != on_line_.end()) {
      const Index lower = *std::prev(above), upper = *above;
      if (!polygon_.meet(lower, upper)) return;
      above = on_line_.erase(above);
      take_out(upper, lower);
    }
  }

  const ClosedPolygon& polygon_;
  const Index most_;
  PollSometimes poll_;
  std::vector<TakenOut> found_;
  std::vector<bool> out_;
  std::vector<Segment> segments_;
  const LineOrder order_{segments_};
  Line on_line_{order_};
  std::vector<Line::iterator> place_;
};

}  // namespace

std::vector<TakenOut> take_out_meeting_edges(const ClosedPolygon& polygon, Index most) {
  return Sweep(polygon, most).run();
}

}  // namespace beltrami
