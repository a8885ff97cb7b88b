// The best view is the one that shows the most surface from its front side: each candidate is
// rasterised small with a depth buffer, and its visible front minus its visible back is counted.
#include "view.h"

#include <algorithm>
#include <numbers>

#include "raster.h"

namespace beltrami::cli {
namespace {

constexpr int kProbeSize = 96;
/// Above this size fewer candidates are tried, to keep the choice within about a second.
constexpr std::size_t kManyFaces = 400000;
/// Mean normal against area: a sphere has 0, a plane 1. Above, the model is looked at like a map.
constexpr double kFlatness = 0.6;

struct Shape {
  Vector3 center{};  ///< weighted by area
  Vector3 normal{};  ///< sum of the face normals, as long as the area
  double area = 0;
  double radius = 0;  ///< of a sphere about the center that holds everything
};

Vector3 vertex(const MeshFile& mesh, std::uint32_t index) {
  const double* p = &mesh.positions[3 * std::size_t{index}];
  return {p[0], p[1], p[2]};
}

Shape measure(const MeshFile& mesh) {
  Shape shape;
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    const Vector3 a = vertex(mesh, mesh.faces[i]), b = vertex(mesh, mesh.faces[i + 1]),
                  c = vertex(mesh, mesh.faces[i + 2]);
    const Vector3 normal = 0.5 * cross(b - a, c - a);
    const double area = norm(normal);
    shape.normal = shape.normal + normal;
    shape.area += area;
    shape.center = shape.center + (area / 3) * (a + b + c);
  }
  if (shape.area > 0) shape.center = (1 / shape.area) * shape.center;
  for (const std::uint32_t corner : mesh.faces) {
    shape.radius = std::max(shape.radius, norm(vertex(mesh, corner) - shape.center));
  }
  return shape;
}

View frame_of(const Vector3& toward, const Vector3& up) {
  View view;
  view.toward = normalized(toward, {0, 0, 1});
  Vector3 right = cross(up, view.toward);
  // Looking along `up`: any other axis will do.
  if (norm(right) < 1e-3)
    right =
        cross(std::abs(view.toward[1]) < 0.9 ? Vector3{0, 1, 0} : Vector3{0, 0, -1}, view.toward);
  view.right = normalized(right, {1, 0, 0});
  view.up = cross(view.toward, view.right);
  return view;
}

/// Samples of visible front minus half of the visible back.
double score(const MeshFile& mesh, const Shape& shape, const View& view) {
  std::vector<float> depths(kProbeSize * kProbeSize, -std::numeric_limits<float>::infinity());
  std::vector<signed char> sides(depths.size(), 0);
  const double scale = shape.radius > 0 ? kProbeSize / (2 * shape.radius) : 0;
  const auto project = [&](std::uint32_t index) {
    const Vector3 p = scale * (vertex(mesh, index) - shape.center);
    return Point{dot(p, view.right) + kProbeSize / 2.0, kProbeSize / 2.0 - dot(p, view.up),
                 dot(p, view.toward)};
  };
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    const Point a = project(mesh.faces[i]), b = project(mesh.faces[i + 1]),
                c = project(mesh.faces[i + 2]);
    // The canvas has y down, which turns the orientation round.
    const bool front = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0;
    visit_triangle(a, b, c, kProbeSize, kProbeSize, [&](int x, int y, const Weights& w) {
      const auto depth = static_cast<float>(w[0] * a.depth + w[1] * b.depth + w[2] * c.depth);
      const std::size_t at = static_cast<std::size_t>(y) * kProbeSize + static_cast<std::size_t>(x);
      if (depth < depths[at]) return;
      depths[at] = depth;
      sides[at] = front ? 1 : -1;
    });
  }
  double total = 0;
  for (const signed char side : sides) total += side > 0 ? 1.0 : 0.5 * side;
  return total;
}

/// Models stand on y or, less often, lie with z up. A boundary below the rest, as of a bust, tells.
Vector3 guess_up(const MeshFile& mesh, const Shape& shape, const std::vector<Vector3>& boundary) {
  const Vector3 fallback = {0, 1, 0};
  if (boundary.empty() || mesh.faces.empty()) return fallback;
  Vector3 middle{};
  for (const Vector3& point : boundary) middle = middle + point;
  const Vector3 rise = shape.center - (1.0 / static_cast<double>(boundary.size())) * middle;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(rise[k]) > std::abs(rise[axis])) axis = k;
  }
  if (std::abs(rise[axis]) < 0.35 * shape.radius) return fallback;
  Vector3 up{};
  up[axis] = rise[axis] > 0 ? 1 : -1;
  return up;
}

}  // namespace

View choose_view(const MeshFile& mesh, const std::vector<Vector3>& boundary) {
  const Shape shape = measure(mesh);
  const Vector3 up = guess_up(mesh, shape, boundary);
  std::vector<View> candidates;
  const Vector3 normal = normalized(shape.normal, up);
  if (norm(shape.normal) > kFlatness * shape.area) {
    const View straight = frame_of(normal, up);
    return frame_of(normal + 0.35 * straight.right + -0.35 * straight.up, straight.up);
  }
  const bool many = mesh.face_count() > kManyFaces;
  const Vector3 side = normalized(cross(up, {up[2], up[0], up[1]}), {1, 0, 0});
  const Vector3 front = cross(side, up);
  const int steps = many ? 8 : 16;
  for (const double elevation : many ? std::vector<double>{0.25} : std::vector<double>{0.1, 0.4}) {
    for (int k = 0; k < steps; ++k) {
      const double angle = 2 * std::numbers::pi * k / steps;
      const Vector3 level = std::cos(angle) * front + std::sin(angle) * side;
      candidates.push_back(frame_of(std::cos(elevation) * level + std::sin(elevation) * up, up));
    }
  }
  View best = candidates.front();
  double best_score = -std::numeric_limits<double>::infinity();
  for (const View& candidate : candidates) {
    const double found = score(mesh, shape, candidate);
    if (found > best_score) {
      best_score = found;
      best = candidate;
    }
  }
  return best;
}

}  // namespace beltrami::cli
