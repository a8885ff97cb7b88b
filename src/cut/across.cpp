#include "cut/across.h"

#include <limits>
#include <queue>
#include <utility>

namespace beltrami {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

PathsAcross::PathsAcross(const Surface& surface, const EdgeMarks& seams,
                         std::function<bool(Index)> is_on, const std::vector<double>& cost)
    : surface_(surface),
      seams_(seams),
      is_on_(std::move(is_on)),
      cost_(cost),
      leaves_(surface.twin.size(), false),
      costs_(surface.positions.size(), kFar),
      from_(surface.positions.size(), kNone) {}

/// The next side around the origin of a half-edge, or none.
Index PathsAcross::side_beside(Index spoke) const {
  Index h = spoke;
  while (!is_side(h)) {
    h = Surface::next(surface_.twin[h]);
    if (h == spoke) return kNone;
  }
  return h;
}

/// To the next side.
void PathsAcross::advance(Trace& trace) const {
  Index h = Surface::next(trace.at);
  for (; !is_side(h); h = Surface::next(surface_.twin[h])) trace.spokes.push_back(h);
  trace.at = h;
  trace.is_closed = h == trace.start;
}

std::vector<Index> PathsAcross::from_loop(Index side, double bound) {
  Trace trace{side, side};
  while (!trace.is_closed) advance(trace);
  return from_spokes(trace.spokes, bound);
}

std::vector<Index> PathsAcross::between_ends(Index first, Index last, double bound) {
  const Index one_side = side_beside(first), other_side = side_beside(last);
  if (one_side == kNone || other_side == kNone || one_side == other_side) return {};
  Trace one{one_side, one_side}, other{other_side, other_side};
  while (true) {
    advance(one);
    if (one.at == other.start) return {};
    if (one.is_closed) return from_spokes(one.spokes, bound);
    advance(other);
    if (other.at == one.start) return {};
    if (other.is_closed) return from_spokes(other.spokes, bound);
  }
}

/// Dijkstra's algorithm.
std::vector<Index> PathsAcross::from_spokes(const std::vector<Index>& spokes, double bound) {
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<Index> reached;
  double best = bound;
  Index last = kNone;
  const auto go = [&](double so_far, Index h) {
    const double now = so_far + cost_[h];
    const Index v = surface_.target(h);
    if (now >= best) return;
    if (is_on_(v)) {
      if (leaves_[surface_.twin[h]]) return;
      best = now;
      last = h;
    } else if (now < costs_[v]) {
      if (costs_[v] == kFar) reached.push_back(v);
      costs_[v] = now;
      from_[v] = h;
      queue.emplace(now, v);
    }
  };
  for (const Index h : spokes) leaves_[h] = true;
  for (const Index h : spokes) go(0, h);
  while (!queue.empty() && queue.top().first < best) {
    const auto [so_far, v] = queue.top();
    queue.pop();
    if (so_far > costs_[v]) continue;
    surface_.for_each_outgoing(v, [&, so_far = so_far](Index h) { go(so_far, h); });
  }
  std::vector<Index> path;
  for (Index h = last; h != kNone;) {
    path.push_back(h);
    h = is_on_(surface_.origin(h)) ? kNone : from_[surface_.origin(h)];
  }
  for (const Index v : reached) costs_[v] = kFar;
  for (const Index h : spokes) leaves_[h] = false;
  return {path.rbegin(), path.rend()};
}

}  // namespace beltrami
