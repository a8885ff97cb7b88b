#include "shapes/region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/portable_math.h"

namespace beltrami::shapes {

Loop ellipse(const Point2& centre, double radius_x, double radius_y, int n, double phase) {
  Loop loop;
  for (int i = 0; i < n; ++i) {
    const double angle = phase + 2 * std::numbers::pi * i / n;
    loop.push_back({centre[0] + std::llround(radius_x * portable::cos(angle)),
                    centre[1] + std::llround(radius_y * portable::sin(angle))});
  }
  return loop;
}

Loop rectangle(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

std::vector<Loop> loops_of(const Region& region) {
  std::vector<Loop> loops = {region.outer};
  for (const Loop& hole : region.holes) loops.emplace_back(hole.rbegin(), hole.rend());
  return loops;
}

namespace {

using Points = std::vector<Point2>;
using Ring = std::vector<Vertex>;

Points points_of(const Region& region) {
  Points points;
  for (const Loop& loop : loops_of(region)) points.insert(points.end(), loop.begin(), loop.end());
  return points;
}

std::int64_t turn_of(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

int sign(std::int64_t x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

bool on_segment(const Point2& a, const Point2& b, const Point2& p) {
  return turn_of(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

/// Whether the segments have a point in common that is no end of both.
bool meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const auto ends = [](const Point2& p, const Point2& q, const Point2& x) {
    return x != p && x != q && on_segment(p, q, x);
  };
  if (ends(a, b, c) || ends(a, b, d) || ends(c, d, a) || ends(c, d, b)) return true;
  return sign(turn_of(a, b, c)) * sign(turn_of(a, b, d)) < 0 &&
         sign(turn_of(c, d, a)) * sign(turn_of(c, d, b)) < 0;
}

/// Whether the direction from corner `at` to `target` leads inside.
bool in_cone(const Point2& before, const Point2& at, const Point2& after, const Point2& target) {
  const bool left = turn_of(at, after, target) > 0, right = turn_of(before, at, target) > 0;
  return turn_of(before, at, after) >= 0 ? left && right : left || right;
}

/// The corner of `ring` that is nearest to `from` of those that see it; its size where none does.
std::size_t bridge_end(const Points& points, const Ring& ring, const std::vector<Ring>& others,
                       const Point2& from) {
  std::size_t best = ring.size();
  std::int64_t least = 0;
  const auto blocked = [&](const Ring& edges, const Point2& to) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (meet(from, to, points[edges[i]], points[edges[(i + 1) % edges.size()]])) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2& to = points[ring[i]];
    const std::int64_t dx = to[0] - from[0], dy = to[1] - from[1], distance = dx * dx + dy * dy;
    if (best < ring.size() && distance >= least) continue;
    const Point2& before = points[ring[(i + ring.size() - 1) % ring.size()]];
    if (!in_cone(before, to, points[ring[(i + 1) % ring.size()]], from)) continue;
    if (blocked(ring, to)) continue;
    if (std::any_of(others.begin(), others.end(), [&](const Ring& o) { return blocked(o, to); })) {
      continue;
    }
    best = i;
    least = distance;
  }
  return best;
}

/// All loops as one, by bridges from the rightmost points of holes.
Ring one_ring(const Region& region, const Points& points) {
  std::vector<Ring> rings;
  Vertex next = 0;
  for (const Loop& loop : loops_of(region)) {
    Ring& ring = rings.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) ring.push_back(next++);
    std::rotate(ring.begin(),
                std::max_element(ring.begin(), ring.end(),
                                 [&](Vertex a, Vertex b) { return points[a] < points[b]; }),
                ring.end());
  }
  Ring ring = rings[0];
  std::vector<Ring> holes(rings.begin() + 1, rings.end());
  std::sort(holes.begin(), holes.end(),
            [&](const Ring& a, const Ring& b) { return points[a[0]] > points[b[0]]; });
  for (const Ring& hole : holes) {
    const std::size_t end = bridge_end(points, ring, holes, points[hole[0]]);
    if (end == ring.size()) continue;
    Ring added = hole;
    added.push_back(hole[0]);
    added.push_back(ring[end]);
    ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(end) + 1, added.begin(), added.end());
  }
  return ring;
}

bool is_ear(const Points& points, const Ring& ring, std::size_t i) {
  const std::size_t n = ring.size();
  const Point2& a = points[ring[(i + n - 1) % n]];
  const Point2& b = points[ring[i]];
  const Point2& c = points[ring[(i + 1) % n]];
  if (turn_of(a, b, c) <= 0) return false;
  return std::none_of(ring.begin(), ring.end(), [&](Vertex v) {
    const Point2& p = points[v];
    if (p == a || p == b || p == c) return false;
    return turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 && turn_of(c, a, p) >= 0;
  });
}

/// Twice the area over the square of the longest side.
double shape_of(const Point2& a, const Point2& b, const Point2& c) {
  const auto square = [](const Point2& p, const Point2& q) {
    const auto dx = static_cast<double>(p[0] - q[0]), dy = static_cast<double>(p[1] - q[1]);
    return dx * dx + dy * dy;
  };
  return static_cast<double>(turn_of(a, b, c)) /
         std::max({square(a, b), square(b, c), square(c, a)});
}

}  // namespace

std::vector<std::array<Vertex, 3>> tessellate(const Region& region, Random& random) {
  const Points points = points_of(region);
  Ring ring = one_ring(region, points);
  const bool best_first = random.chance(0.3);
  std::vector<std::array<Vertex, 3>> faces;
  while (ring.size() >= 3) {
    const std::size_t n = ring.size();
    const std::size_t start = random.bits() % n;
    std::size_t ear = n;
    double best = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (start + k) % n;
      if (!is_ear(points, ring, i)) continue;
      const double shape =
          shape_of(points[ring[(i + n - 1) % n]], points[ring[i]], points[ring[(i + 1) % n]]);
      if (shape > best) {
        best = shape;
        ear = i;
      }
      if (!best_first) break;
    }
    if (ear == n) break;  // only corners on a straight line are left
    faces.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return faces;
}

std::vector<Vertex> bridged(const Region& region) {
  return one_ring(region, points_of(region));
}

Shape flat_shape(const Region& region, double unit, Random& random) {
  Shape shape;
  shape.flat = true;
  for (const Point2& p : points_of(region)) {
    shape.add({unit * static_cast<double>(p[0]), unit * static_cast<double>(p[1]), 0});
  }
  if (random.chance(0.15)) {
    shape.face(bridged(region));
  } else {
    for (const auto& [a, b, c] : tessellate(region, random)) shape.face({a, b, c});
  }
  return shape;
}

Shape extrude(const Region& region, const Extrusion& how, Random& random) {
  Shape shape;
  const Points points = points_of(region);
  const auto n = static_cast<Vertex>(points.size());
  for (int layer = 0; layer <= how.layers; ++layer) {
    const double t = static_cast<double>(layer) / how.layers;
    const double size = how.unit * (1 + t * (how.taper - 1));
    for (const Point2& p : points) {
      shape.add(
          {size * static_cast<double>(p[0]), size * static_cast<double>(p[1]), t * how.height});
    }
  }
  const Vertex top = n * static_cast<Vertex>(how.layers);
  if (how.lid) {
    for (const auto& [a, b, c] : tessellate(region, random)) shape.face({a, c, b});
    for (const auto& [a, b, c] : tessellate(region, random))
      shape.face({top + a, top + b, top + c});
  }
  for (Vertex below = 0; below < top; below += n) {
    Vertex first = below;
    for (const Loop& loop : loops_of(region)) {
      const auto size = static_cast<Vertex>(loop.size());
      for (Vertex i = 0; i < size; ++i) {
        const Vertex a = first + i, b = first + (i + 1) % size;
        if (how.quads) {
          shape.face({a, b, b + n, a + n});
        } else {
          shape.face({a, b, b + n});
          shape.face({a, b + n, a + n});
        }
      }
      first += size;
    }
  }
  return shape;
}

}  // namespace beltrami::shapes
