#include "local/kernel.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// Of a region: each of the polygon's edges takes time for each of them.
constexpr std::size_t kMostCorners = 256;

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The part of a polygon to the left of the line from a to b (Sutherland & Hodgman 1974).
std::vector<Vec2> clip(const std::vector<Vec2>& polygon, const Vec2& a, const Vec2& b) {
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double dp = cross(a, b, p), dq = cross(a, b, q);
    if (dp >= 0) result.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) result.push_back(p + dp / (dp - dq) * (q - p));
  }
  return result;
}

/// Drops a quarter of the corners of a convex polygon, those that matter least of every second one:
/// what is left is a part of it.
void thin_out(std::vector<Vec2>& polygon) {
  std::vector<std::pair<double, std::size_t>> ears;  // area that goes with the corner
  for (std::size_t i = 1; i + 1 < polygon.size(); i += 2) {
    ears.emplace_back(cross(polygon[i - 1], polygon[i], polygon[i + 1]), i);
  }
  const auto half = ears.begin() + static_cast<std::ptrdiff_t>(ears.size() / 2);
  std::nth_element(ears.begin(), half, ears.end());
  std::vector<bool> dropped(polygon.size(), false);
  for (auto ear = ears.begin(); ear != half; ++ear) dropped[ear->second] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (!dropped[i]) polygon[kept++] = polygon[i];
  }
  polygon.resize(kept);
}

/// The points from which the whole polygon is visible, or of a region with very many corners most
/// of them; empty if there are none.
std::vector<Vec2> kernel(const std::vector<Vec2>& polygon) {
  Vec2 low = polygon.front(), high = polygon.front();
  for (const Vec2& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<Vec2> region = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  PollSometimes poll;
  for (std::size_t i = 0; i < polygon.size() && !region.empty(); ++i) {
    poll();
    region = clip(region, polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
    if (region.size() > kMostCorners) thin_out(region);
  }
  return region;
}

}  // namespace

std::optional<Vec2> kernel_centroid(const std::vector<Vec2>& polygon) {
  const std::vector<Vec2> region = kernel(polygon);
  double area = 0;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 2; i < region.size(); ++i) {
    const double part = cross(region[0], region[i - 1], region[i]);
    area += part;
    sum += part * (region[0] + region[i - 1] + region[i]) / 3;
  }
  if (!(area > 0)) return std::nullopt;
  return sum / area;
}

}  // namespace beltrami
