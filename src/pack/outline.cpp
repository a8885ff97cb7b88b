#include "pack/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "base/interrupt.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

using Directed = std::array<Index, 2>;

/// The edges that are left once opposite ones have cancelled one another, by their lower end, then
/// by the other one. `count`: of the points.
std::vector<Directed> uncancelled(const std::vector<Directed>& edges, Index count) {
  PollSometimes poll;
  std::vector<Index> first(static_cast<std::size_t>(count) + 1, 0);  // of those with a lower end
  for (const auto& [from, to] : edges) {
    poll();
    ++first[std::min(from, to) + 1];
  }
  for (Index p = 0; p < count; ++p) first[p + 1] += first[p];
  struct Rest {
    Index high;
    Index balance;  ///< 1: from low to high, -1: back
  };
  std::vector<Rest> sorted(edges.size());
  for (const auto& [from, to] : edges) {
    poll();
    sorted[first[std::min(from, to)]++] = {std::max(from, to), from < to ? 1 : -1};
  }
  // By now `first` has the ends.
  std::vector<Directed> left;
  for (Index low = 0; low < count; ++low) {
    poll();
    const auto begin = sorted.begin() + (low > 0 ? first[low - 1] : 0);
    const auto end = sorted.begin() + first[low];
    // A hub may have most of the edges.
    sort_interruptibly(begin, end, [](const Rest& a, const Rest& b) { return a.high < b.high; });
    for (auto next = begin; next != end;) {
      const Index high = next->high;
      Index balance = 0;
      for (; next != end && next->high == high; ++next) balance += next->balance;
      for (; balance > 0; --balance) left.push_back({low, high});
      for (; balance < 0; ++balance) left.push_back({high, low});
    }
  }
  return left;
}

/// Andrew's monotone chain.
std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  const auto less = [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  sort_interruptibly(points.begin(), points.end(), less);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& p, std::size_t least) {
    while (hull.size() > least &&
           cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vec2& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

}  // namespace

Outline outline_of(const PackChart& chart) {
  double area = 0;
  std::vector<Directed> all;
  all.reserve(3 * chart.faces.size());
  for (const Triangle& f : chart.faces) {
    const Vec2& a = chart.points[f[0]];
    const double twice = cross(chart.points[f[1]] - a, chart.points[f[2]] - a);
    area += 0.5 * std::abs(twice);
    for (int k = 0; k < 3; ++k) {
      const Directed edge{f[k], f[next_corner(k)]};
      if (edge[0] != edge[1]) all.push_back(twice < 0 ? Directed{edge[1], edge[0]} : edge);
    }
  }
  return outline_of(chart.points, all, area);
}

Outline outline_of(const std::vector<Vec2>& points, const std::vector<Directed>& edges,
                   double area) {
  Outline outline;
  outline.area = area;
  outline.edges = uncancelled(edges, size_of(points));
  std::vector<Index> place(points.size(), kNone);
  for (Directed& edge : outline.edges) {
    outline.length += (points[edge[1]] - points[edge[0]]).norm();
    for (Index& end : edge) {
      if (place[end] == kNone) {
        place[end] = size_of(outline.points);
        outline.points.push_back(points[end]);
      }
      end = place[end];
    }
  }
  outline.hull = hull_of(outline.points);
  return outline;
}

Vec2 nearest_on(const Vec2& p, const Vec2& q, const Vec2& place) {
  const Vec2 along = q - p;
  const double squared = along.squaredNorm();
  if (!(squared > 0)) return p;
  return p + along * std::clamp((place - p).dot(along) / squared, 0.0, 1.0);
}

PlacedOutline placed(const Outline& outline, const Placement& placement, double density) {
  PlacedOutline chart{placement.page, {}, outline.edges};
  chart.points.reserve(outline.points.size());
  for (const Vec2& p : outline.points) chart.points.push_back(placement.place(p, density));
  return chart;
}

void thin(Outline& outline, double width) {
  const Index count = size_of(outline.points);
  std::vector<Index> next(count, kNone), in(count, 0), out(count, 0);
  for (const auto& [from, to] : outline.edges) {
    next[from] = to;
    ++out[from];
    ++in[to];
  }
  std::vector<std::array<Index, 2>> edges;
  std::vector<bool> seen(count, false);
  const auto is_plain = [&](Index p) { return in[p] == 1 && out[p] == 1; };
  PollSometimes poll;
  const auto walk = [&](Index from, Index first) {
    // One edge after the other is added to the replaced ones, until one of their points is far.
    std::vector<Index> passed;
    Index start = from, here = first;
    for (;;) {
      poll();
      const bool ends = !is_plain(here) || seen[here];
      if (!ends) seen[here] = true;
      const Index beyond = ends ? kNone : next[here];
      passed.push_back(here);
      bool far = ends || passed.size() > 64;
      for (std::size_t i = 0; !far && i < passed.size(); ++i) {
        const Vec2& p = outline.points[passed[i]];
        far = (nearest_on(outline.points[start], outline.points[beyond], p) - p).norm() > width;
      }
      if (far) {
        edges.push_back({start, here});
        start = here;
        passed.clear();
      }
      if (ends) return;
      here = beyond;
    }
  };
  for (const auto& [from, to] : outline.edges) {
    if (!is_plain(from)) walk(from, to);
  }
  for (Index p = 0; p < count; ++p) {
    if (!is_plain(p) || seen[p]) continue;
    seen[p] = true;
    walk(p, next[p]);
  }
  std::vector<Index> place(count, kNone);
  std::vector<Vec2> points;
  for (auto& edge : edges) {
    for (Index& end : edge) {
      if (place[end] == kNone) {
        place[end] = size_of(points);
        points.push_back(outline.points[end]);
      }
      end = place[end];
    }
  }
  outline.points = std::move(points);
  outline.edges = std::move(edges);
}

Vec2 turn_to_least_box(const std::vector<Vec2>& hull) {
  Vec2 best(1, 0);
  if (hull.size() < 2) return best;
  double least = std::numeric_limits<double>::infinity();
  const auto after = [&](std::size_t i) { return i + 1 < hull.size() ? i + 1 : 0; };
  // The points that are furthest along an edge, across it and against it go round with it
  // (Toussaint 1983).
  std::array<std::size_t, 3> furthest{};
  bool are_found = false;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 edge = hull[after(i)] - hull[i];
    const double length = portable::hypot(edge.x(), edge.y());
    if (!(length > 0)) continue;
    const Vec2 along = edge / length, across(-along.y(), along.x());
    const std::array<Vec2, 3> ways = {along, across, -along};
    for (std::size_t k = 0; k < 3; ++k) {
      std::size_t& far = furthest[k];
      const auto reach = [&](std::size_t p) { return ways[k].dot(hull[p]); };
      for (std::size_t p = 0; p < hull.size() && !are_found; ++p) {
        if (reach(p) > reach(far)) far = p;
      }
      for (std::size_t step = 0; step < hull.size() && reach(after(far)) > reach(far); ++step) {
        far = after(far);
      }
    }
    are_found = true;
    const double low = std::min(across.dot(hull[i]), across.dot(hull[after(i)]));
    const Vec2 size(along.dot(hull[furthest[0]]) - along.dot(hull[furthest[2]]),
                    across.dot(hull[furthest[1]]) - low);
    if (size.prod() < least) {
      least = size.prod();
      best = size.x() >= size.y() ? Vec2(along.x(), -along.y()) : Vec2(along.y(), along.x());
    }
  }
  return best;
}

}  // namespace beltrami
