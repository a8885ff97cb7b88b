#include "cut/turning.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "base/portable_math.h"

namespace beltrami {
namespace {

/// Of the corner that a half-edge leaves from.
double corner_angle(const Surface& surface, Index h) {
  const Vec3& p = surface.positions[surface.origin(h)];
  const Vec3 a = surface.positions[surface.target(h)] - p;
  const Vec3 b = surface.positions[surface.origin(Surface::previous(h))] - p;
  return portable::atan2(a.cross(b).norm(), a.dot(b));
}

/// Calls visit(half-edge, direction) for those out of a vertex, by the angles between them on the
/// full circle.
template <class Visit>
void for_each_direction(const Surface& surface, Index vertex, const Visit& visit) {
  double sum = 0;
  surface.for_each_outgoing(vertex, [&](Index h) { sum += corner_angle(surface, h); });
  const double scale = sum > 0 ? 2 * std::numbers::pi / sum : 0;
  double angle = 0;
  surface.for_each_outgoing(vertex, [&](Index h) {
    visit(h, Vec2(portable::cos(scale * angle), portable::sin(scale * angle)));
    angle += corner_angle(surface, h);
  });
}

}  // namespace

double Turning::cost(Index in, Index out) const {
  if (weight_ == 0 || in == kNone || out == kNone) return 0;
  Way back{surface_.twin[in], Vec2::Zero(), 0, kNone}, on{out, Vec2::Zero(), 0, kNone};
  for_each_direction(surface_, surface_.origin(out), [&](Index h, const Vec2& direction) {
    if (h == back.halfedge) back.direction = direction;
    if (h == out) on.direction = direction;
  });
  return turn(back, on);
}

/// From where `back` leads to, into `on`: none where one is the other turned around.
double Turning::turn(const Way& back, const Way& on) const {
  const double mean = (cost_[back.halfedge] + cost_[on.halfedge]) / 2;
  return weight_ * mean * (1 + back.direction.dot(on.direction));
}

double Turning::cost(const Piece& piece) const {
  double sum = 0;
  Index last = piece.before;
  for (const Index h : piece.path) {
    sum += cost_[h] + cost(last, h);
    last = h;
  }
  return sum + cost(last, piece.after);
}

void Turning::fan_out(const SeamPatch& patch) {
  ways_.clear();
  first_.clear();
  for (Index n = 0; n < patch.size(); ++n) {
    poll_();
    first_.push_back(size_of(ways_));
    for_each_direction(surface_, patch.vertex(n), [&](Index h, const Vec2& direction) {
      ways_.push_back({h, direction, std::numeric_limits<double>::infinity(), kNone});
    });
  }
  first_.push_back(size_of(ways_));
}

std::vector<Index> Turning::cheapest(const Piece& piece, const SeamPatch& patch,
                                     const PathQuery& query, const EdgeMarks& locked,
                                     const EdgeMarks& seams) {
  fan_out(patch);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  double best = query.below;
  Index last = kNone;
  // On from a vertex that was reached over a way, or from the start.
  const auto go_on = [&](Index v, Index in, Index from, double so_far) {
    const Index n = patch.number(v);
    const Index twin = in == kNone ? kNone : surface_.twin[in];
    const Way* back = nullptr;
    for (Index w = first_[n]; w < first_[n + 1]; ++w) {
      if (twin != kNone && ways_[w].halfedge == twin) back = &ways_[w];
    }
    for (Index w = first_[n]; w < first_[n + 1]; ++w) {
      Way& on = ways_[w];
      const Index h = on.halfedge, other = surface_.target(h);
      if (patch.number(other) == kNone || surface_.twin[h] == kNone || &on == back) continue;
      if (!locked.empty() && locked[h] && !seams[h]) continue;
      if (v == query.start && (other == query.not_between || from != kNone)) continue;
      const double through = so_far + cost_[h] + (back == nullptr ? 0 : turn(*back, on));
      if (!(through < best) || !(through < on.so_far)) continue;
      on.so_far = through;
      on.last = from;
      queue.emplace(through, w);
    }
  };
  go_on(query.start, piece.before, kNone, 0);
  while (!queue.empty()) {
    poll_();
    const auto [so_far, w] = queue.top();
    queue.pop();
    if (so_far >= best) break;
    if (so_far > ways_[w].so_far) continue;
    const Index h = ways_[w].halfedge, v = surface_.target(h);
    if (v != query.goal) {
      go_on(v, h, w, so_far);
    } else if (const double whole = so_far + cost(h, piece.after); whole < best) {
      best = whole;
      last = w;
    }
  }
  std::vector<Index> path, vertices;
  for (Index w = last; w != kNone; w = ways_[w].last) path.push_back(ways_[w].halfedge);
  std::reverse(path.begin(), path.end());
  for (const Index h : path) vertices.push_back(surface_.target(h));
  std::sort(vertices.begin(), vertices.end());
  const bool touches = std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end();
  return touches ? std::vector<Index>() : path;
}

}  // namespace beltrami
