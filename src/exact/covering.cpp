// After Bentley & Ottmann 1979, "Algorithms for reporting and counting geometric intersections",
// but that it needs no point of intersection: it ends where the first would be.
#include "exact/covering.h"

#include <algorithm>
#include <set>

#include "base/bucket_sort.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/line_order.h"
#include "exact/orientation.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
constexpr Index kReportEvery = 1 << 16;

/// The places of the boundary's vertices in the order in which the line reaches them, and the edges
/// by the places where they begin. Vertices with equal coordinates share a place.
struct Events {
  std::vector<Vec2> places;
  std::vector<Segment> segments;         ///< per edge, in the order of their left ends
  std::vector<UvEdge> edges;             ///< likewise
  std::vector<Index> right;              ///< place of the right end, likewise
  std::vector<std::uint8_t> goes_right;  ///< whether its triangle is above it, likewise
  std::vector<Index> begins, end_start;  ///< ranges per place: of edges, and of `ending`
  std::vector<Index> ending;             ///< edges by the places of their right ends
};

/// Place of each vertex that the edges use.
std::vector<Index> number_places(const std::vector<Vec2>& uvs, const std::vector<UvEdge>& edges,
                                 std::vector<Vec2>& places) {
  struct Vertex {
    double x, y;
    Index vertex;
  };
  std::vector<Vertex> order;
  std::vector<Index> place_of(uvs.size(), kNone);
  PollSometimes poll;
  for (const UvEdge& e : edges) {
    poll();
    for (const Index v : {e.from, e.to}) {
      if (place_of[v] == kNone) order.push_back({uvs[v].x(), uvs[v].y(), place_of[v] = v});
    }
  }
  sort_interruptibly(order.begin(), order.end(), [](const Vertex& a, const Vertex& b) {
    return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.vertex < b.vertex)));
  });
  for (const Vertex& v : order) {
    poll();
    const Vec2 here(v.x, v.y);
    if (places.empty() || places.back() != here) places.push_back(here);
    place_of[v.vertex] = size_of(places) - 1;
  }
  return place_of;
}

Events make_events(const std::vector<Vec2>& uvs, const std::vector<UvEdge>& edges,
                   const Work& work) {
  Events events;
  const std::vector<Index> place_of = number_places(uvs, edges, events.places);
  const std::int64_t count = size_of(edges), places = size_of(events.places);
  const auto left = [&](const UvEdge& e) { return std::min(place_of[e.from], place_of[e.to]); };
  const auto right = [&](const UvEdge& e) { return std::max(place_of[e.from], place_of[e.to]); };
  BucketSort<Index> begin(work, count, places, events.begins,
                          [&](std::int64_t e, const auto& visit) { visit(left(edges[e])); });
  events.edges.resize(edges.size());
  begin.place(
      [&](std::int64_t e, const auto& visit) { events.edges[visit(left(edges[e]))] = edges[e]; });
  events.segments.resize(edges.size());
  events.right.resize(edges.size());
  events.goes_right.resize(edges.size());
  parallel_for(work, count, kGrain, [&](std::int64_t from, std::int64_t until) {
    for (std::int64_t e = from; e < until; ++e) {
      const UvEdge& edge = events.edges[e];
      events.right[e] = right(edge);
      events.goes_right[e] = place_of[edge.to] == events.right[e];
      events.segments[e] = {events.places[left(edge)], events.places[right(edge)]};
    }
  });
  BucketSort<Index> end(work, count, places, events.end_start,
                        [&](std::int64_t e, const auto& visit) { visit(events.right[e]); });
  events.ending.resize(edges.size());
  end.place([&](std::int64_t e, const auto& visit) {
    events.ending[visit(events.right[e])] = static_cast<Index>(e);
  });
  return events;
}

/// Invariant: of the edges on the line no two cross at or before it, and no two neighbours on it
/// cross anywhere, so their order along the line is the same all the way; edges that lie on one
/// line are neighbours. `above_` holds, for the highest of those, the number of triangles above it.
class Sweep {
 public:
  explicit Sweep(const Events& events)
      : events_(events),
        order_(events.segments),
        above_(events.edges.size(), 0),
        on_line_(SlotOrder{order_}),
        at_(events.edges.size(), on_line_.end()) {}

  Covering run(const Work& work) {
    const Index count = size_of(events_.places);
    for (Index place = 0; place < count; ++place) {
      if (place % kReportEvery == 0) work.report(static_cast<double>(place) / count);
      if (!visit(place)) break;
    }
    return found_;
  }

 private:
  /// An edge on the line, in whose place another may come.
  struct Slot {
    mutable Index edge;
  };
  struct SlotOrder {
    using is_transparent = void;
    LineOrder order;
    bool operator()(const Slot& e, const Slot& f) const { return order(e.edge, f.edge); }
    bool operator()(const Slot& e, const Vec2& p) const { return order(e.edge, p); }
    bool operator()(const Vec2& p, const Slot& e) const { return order(p, e.edge); }
  };
  using Line = std::set<Slot, SlotOrder>;

  /// Takes the edges through a place off the line that end there, and puts those on that begin.
  bool visit(Index place) {
    const Vec2& here = events_.places[place];
    const auto [first, last] = through(place);
    const bool has_below = first != on_line_.begin(), has_above = last != on_line_.end();
    const auto below = has_below ? std::prev(first) : last;
    leaving_.clear();
    for (auto at = first; at != last; ++at) {
      if (events_.right[at->edge] != place) leaving_.push_back(at->edge);
    }
    note_touching(place);
    for (std::size_t i = 1; i < leaving_.size(); ++i) {
      if (turn(here, leaving_[i - 1], leaving_[i]) != 0) return refuse(leaving_[i]);
    }
    for (Index e = events_.begins[place]; e < events_.begins[place + 1]; ++e) leaving_.push_back(e);
    sort_interruptibly(leaving_.begin(), leaving_.end(), [&](Index e, Index f) {
      const int side = turn(here, e, f);
      return side > 0 || (side == 0 && e < f);
    });
    if (!count_up(here, has_below ? above_[below->edge] : 0)) return false;
    put_on_line(first, last);
    if (leaving_.empty()) return !has_below || !has_above || keep_apart(below->edge, last->edge);
    return (!has_below || keep_apart(below->edge, leaving_.front())) &&
           (!has_above || keep_apart(leaving_.back(), last->edge));
  }

  /// Counts a place that an edge goes through, or where edges end that do not share their vertex.
  /// Boundaries that touch and do not cross have such a place in common.
  void note_touching(Index place) {
    Index vertex = kNone;
    bool touching = !leaving_.empty();
    const auto meet = [&](Index v) {
      touching = touching || (vertex != kNone && v != vertex);
      vertex = vertex == kNone ? v : std::min(v, vertex);
    };
    for (Index e = events_.begins[place]; e < events_.begins[place + 1]; ++e) {
      meet(events_.goes_right[e] ? events_.edges[e].from : events_.edges[e].to);
    }
    for (Index i = events_.end_start[place]; i < events_.end_start[place + 1]; ++i) {
      const Index e = events_.ending[i];
      meet(events_.goes_right[e] ? events_.edges[e].to : events_.edges[e].from);
    }
    if (!touching) return;
    const Index known = found_.first_touching;
    found_.first_touching = known == kNone ? vertex : std::min(known, vertex);
    ++found_.touching_places;
  }

  /// The edges on the line that a place lies on, its right ends included.
  std::pair<Line::iterator, Line::iterator> through(Index place) const {
    const Vec2& here = events_.places[place];
    const Index ending = events_.end_start[place];
    const bool none_ends = ending == events_.end_start[place + 1];
    auto first = none_ends ? on_line_.lower_bound(here) : at_[events_.ending[ending]];
    auto last = first;
    while (last != on_line_.end() && order_.side(last->edge, here) == 0) ++last;
    while (first != on_line_.begin() && order_.side(std::prev(first)->edge, here) == 0) --first;
    return {first, last};
  }

  /// 1 if f leaves the place to the left of e, -1 to its right, 0 in the same direction.
  int turn(const Vec2& here, Index e, Index f) const {
    return orientation(here, events_.segments[e].right, events_.segments[f].right);
  }

  /// Counts the triangles above the edges that leave the place, from those below them upwards.
  bool count_up(const Vec2& here, Index number) {
    Index covered = kNone;  // of the edges on one line, one whose triangle is above it
    for (std::size_t i = 0; i < leaving_.size(); ++i) {
      const Index e = leaving_[i];
      if (events_.goes_right[e]) covered = e;
      number += events_.goes_right[e] ? 1 : -1;
      above_[e] = number;
      // Between edges on one line there is nothing to count.
      if (i + 1 < leaving_.size() && turn(here, e, leaving_[i + 1]) == 0) continue;
      if (number > 1) return refuse(covered);
      covered = kNone;
    }
    return true;
  }

  /// Replaces the edges in [first, last) by those that leave the place.
  void put_on_line(Line::iterator first, Line::iterator last) {
    std::size_t i = 0;
    for (; first != last && i < leaving_.size(); ++first, ++i) {
      first->edge = leaving_[i];
      at_[leaving_[i]] = first;
    }
    while (first != last) first = on_line_.erase(first);
    for (; i < leaving_.size(); ++i) at_[leaving_[i]] = on_line_.insert(last, Slot{leaving_[i]});
  }

  /// Whether two neighbours on the line do not cross: the one that ends first is still on its side.
  bool keep_apart(Index lower, Index upper) {
    const Index lower_end = events_.right[lower], upper_end = events_.right[upper];
    const bool crossed =
        lower_end < upper_end
            ? order_.side(upper, events_.segments[lower].right) > 0
            : upper_end < lower_end && order_.side(lower, events_.segments[upper].right) < 0;
    return !crossed || refuse(lower);
  }

  bool refuse(Index edge) {
    found_.doubled = events_.edges[edge].corner;
    return false;
  }

  const Events& events_;
  const LineOrder order_;
  std::vector<Index> above_;
  Line on_line_;
  std::vector<Line::iterator> at_;
  std::vector<Index> leaving_;  // edges that go on from a place or begin there, upwards
  Covering found_;
};

}  // namespace

Covering sweep_covering(const SignedTriangles& triangles, const std::vector<UvEdge>& boundary,
                        const Work& work) {
  const Events events = make_events(triangles.uvs, boundary, work);
  return Sweep(events).run(work);
}

}  // namespace beltrami
