#include "bake/nearest_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

constexpr std::size_t kFacesOfLeaf = 4;

SpacePoint minus(const SpacePoint& a, const SpacePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const SpacePoint& a, const SpacePoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool is_finite(const SpaceTriangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [](const SpacePoint& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
}

/// a / (a + b) for numbers that are not negative.
double share(double a, double b) {
  return a + b > 0 ? a / (a + b) : 0.0;
}

/// The weights of the point of a triangle that is nearest (Ericson, "Real-Time Collision
/// Detection", 5.1.5).
std::array<double, 3> nearest_weights(const SpacePoint& p, const SpaceTriangle& triangle) {
  const auto& [a, b, c] = triangle;
  const SpacePoint ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const SpacePoint bp = minus(p, b);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = share(d1, -d3);
    return {1 - t, t, 0};
  }
  const SpacePoint cp = minus(p, c);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = share(d2, -d6);
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = share(d4 - d3, d5 - d6);
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

double distance_sq_to_box(const SpacePoint& point, const SpacePoint& low, const SpacePoint& high) {
  double sum = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const double beside = std::max({low[d] - point[d], point[d] - high[d], 0.0});
    sum += beside * beside;
  }
  return sum;
}

}  // namespace

SpacePoint normal_of(const SpaceTriangle& triangle) {
  const SpacePoint u = minus(triangle[1], triangle[0]), v = minus(triangle[2], triangle[0]);
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

NearestFace::NearestFace(std::vector<SpaceTriangle> triangles)
    : triangles_(std::move(triangles)), normals_(triangles_.size()) {
  std::vector<SpacePoint> middles(triangles_.size());
  for (std::size_t f = 0; f < triangles_.size(); ++f) {
    const auto& [a, b, c] = triangles_[f];
    normals_[f] = normal_of(triangles_[f]);
    for (std::size_t d = 0; d < 3; ++d) middles[f][d] = (a[d] + b[d] + c[d]) / 3;
    if (is_finite(triangles_[f]) && dot(normals_[f], normals_[f]) > 0) {
      order_.push_back(static_cast<std::uint32_t>(f));
    }
  }
  if (order_.empty()) return;
  nodes_.reserve(2 * order_.size());
  nodes_.emplace_back();
  build(0, 0, order_.size(), middles);
  const SpacePoint across = minus(nodes_[0].high, nodes_[0].low);
  size_ = std::sqrt(dot(across, across));
}

void NearestFace::build(std::size_t node, std::size_t begin, std::size_t end,
                        const std::vector<SpacePoint>& middles) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SpacePoint low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
  SpacePoint first = low, last = high;  // of the middles
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      for (const SpacePoint& corner : triangles_[order_[i]]) {
        low[d] = std::min(low[d], corner[d]);
        high[d] = std::max(high[d], corner[d]);
      }
      first[d] = std::min(first[d], middles[order_[i]][d]);
      last[d] = std::max(last[d], middles[order_[i]][d]);
    }
  }
  nodes_[node].low = low;
  nodes_[node].high = high;
  if (end - begin <= kFacesOfLeaf) {
    nodes_[node].first = static_cast<std::uint32_t>(begin);
    nodes_[node].count = static_cast<std::uint32_t>(end - begin);
    return;
  }
  poll_interrupt();
  const SpacePoint extents = minus(last, first);
  const auto axis =
      static_cast<std::size_t>(std::max_element(extents.begin(), extents.end()) - extents.begin());
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t f, std::uint32_t g) {
    const double a = middles[f][axis], b = middles[g][axis];
    return a < b || (a == b && f < g);
  });
  const std::size_t left = nodes_.size();
  nodes_[node].first = static_cast<std::uint32_t>(left);
  nodes_.resize(left + 2);
  build(left, begin, middle, middles);
  build(left + 1, middle, end, middles);
}

void NearestFace::consider(const SpacePoint& point, const SpacePoint& normal, std::size_t face,
                           Best& best) const {
  if (!(dot(normals_[face], normal) > 0)) return;
  const std::array<double, 3> weights = nearest_weights(point, triangles_[face]);
  SpacePoint away = point;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t d = 0; d < 3; ++d) away[d] -= weights[k] * triangles_[face][k][d];
  }
  const double distance_sq = dot(away, away);
  const bool is_first = !best.place || face < best.place->face;
  if (distance_sq < best.distance_sq || (distance_sq == best.distance_sq && is_first)) {
    best = {OnFace{face, weights}, distance_sq};
  }
}

std::optional<OnFace> NearestFace::find(const SpacePoint& point, const SpacePoint& normal,
                                        double reach, std::size_t hint) const {
  Best best{std::nullopt, reach * reach};
  if (nodes_.empty()) return best.place;
  if (hint < triangles_.size()) consider(point, normal, hint, best);
  struct Entry {
    std::size_t node;
    double distance_sq;
  };
  const auto entry_of = [&](std::size_t node) {
    return Entry{node, distance_sq_to_box(point, nodes_[node].low, nodes_[node].high)};
  };
  std::array<Entry, 80> stack{};  // the tree halves its faces: depth 32 at most, an entry a level
  std::size_t top = 0;
  stack[top++] = entry_of(0);
  while (top > 0) {
    const Entry entry = stack[--top];
    // As far as the best is looked at, too: the smaller number wins whatever the hint was.
    if (!(entry.distance_sq <= best.distance_sq)) continue;
    const Node& node = nodes_[entry.node];
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      consider(point, normal, order_[i], best);
    }
    if (node.count > 0) continue;
    const Entry left = entry_of(node.first), right = entry_of(node.first + 1);
    const bool left_first = left.distance_sq <= right.distance_sq;
    stack[top++] = left_first ? right : left;
    stack[top++] = left_first ? left : right;
  }
  return best.place;
}

}  // namespace beltrami
