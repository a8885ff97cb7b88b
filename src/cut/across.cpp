#include "cut/across.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace beltrami {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

class Annulus {
 public:
  Annulus(const Surface& surface, const EdgeMarks& seams, Index halfedge)
      : surface_(surface), seams_(seams), loop_(surface.twin.size(), kNone) {
    flood(halfedge / 3);
    for (Index h = 0; h < size_of(loop_); ++h) {
      if (in_piece_[h / 3] && is_side(h) && loop_[h] == kNone) trace(h);
    }
  }

  Index loops() const { return loops_; }
  std::vector<Index> cheapest_path(const std::vector<bool>& is_on, const std::vector<double>& cost,
                                   double bound) const;

 private:
  bool is_side(Index h) const { return seams_[h] || surface_.twin[h] == kNone; }
  void flood(Index face);
  void trace(Index side);

  const Surface& surface_;
  const EdgeMarks& seams_;
  std::vector<bool> in_piece_;
  /// Per half-edge, the loop that it is on, or that it leaves into the piece; kNone elsewhere.
  std::vector<Index> loop_;
  Index loops_ = 0;
};

void Annulus::flood(Index face) {
  in_piece_.assign(surface_.faces.size(), false);
  in_piece_[face] = true;
  std::vector<Index> open = {face};
  while (!open.empty()) {
    const Index f = open.back();
    open.pop_back();
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (is_side(h) || in_piece_[surface_.twin[h] / 3]) continue;
      in_piece_[surface_.twin[h] / 3] = true;
      open.push_back(surface_.twin[h] / 3);
    }
  }
}

void Annulus::trace(Index side) {
  for (Index h = side; loop_[h] == kNone;) {
    loop_[h] = loops_;
    h = Surface::next(h);
    for (; !is_side(h); h = Surface::next(surface_.twin[h])) loop_[h] = loops_;
  }
  ++loops_;
}

std::vector<Index> Annulus::cheapest_path(const std::vector<bool>& is_on,
                                          const std::vector<double>& cost, double bound) const {
  std::vector<double> costs(surface_.positions.size(), kFar);
  std::vector<Index> from(costs.size(), kNone);  // the half-edge of the way that ends there
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  double best = bound;
  Index last = kNone;
  const auto go = [&](double so_far, Index h) {
    const double now = so_far + cost[h];
    const Index v = surface_.target(h);
    if (now >= best) return;
    if (is_on[v]) {
      if (loop_[surface_.twin[h]] != 1) return;
      best = now;
      last = h;
    } else if (now < costs[v]) {
      costs[v] = now;
      from[v] = h;
      queue.emplace(now, v);
    }
  };
  for (Index h = 0; h < size_of(loop_); ++h) {
    if (loop_[h] == 0 && !is_side(h)) go(0, h);
  }
  while (!queue.empty() && queue.top().first < best) {
    const auto [so_far, v] = queue.top();
    queue.pop();
    if (so_far > costs[v]) continue;
    surface_.for_each_outgoing(v, [&, so_far = so_far](Index h) { go(so_far, h); });
  }
  std::vector<Index> path;
  for (Index h = last; h != kNone;
       h = is_on[surface_.origin(h)] ? kNone : from[surface_.origin(h)]) {
    path.push_back(h);
  }
  return {path.rbegin(), path.rend()};
}

}  // namespace

std::vector<Index> path_across(const Surface& surface, const EdgeMarks& seams,
                               const std::vector<bool>& is_on, Index halfedge,
                               const std::vector<double>& cost, double bound) {
  const Annulus annulus(surface, seams, halfedge);
  if (annulus.loops() != 2) return {};
  return annulus.cheapest_path(is_on, cost, bound);
}

}  // namespace beltrami
