// The best view is the one that shows the most: for each candidate the mesh is rasterised small
// with a depth buffer, and what its visible front faces weigh is added up. A face weighs its share
// of the area, as it is seen, and its share of the bending, so that a face wins over the back of
// the head.
#include "picture/view.h"

#include <algorithm>
#include <numbers>

#include "picture/raster.h"

namespace beltrami::cli {
namespace {

constexpr int kProbeSize = 96;
/// Above this size fewer candidates are tried, to keep the choice within about a second.
constexpr std::size_t kManyFaces = 400000;
/// Mean normal against area: a sphere has 0, a plane 1. Above, the model is looked at like a map.
constexpr double kFlatness = 0.6;
/// What all the bending of a surface weighs against all its area.
constexpr double kBending = 0.5;

struct Shape {
  Vector3 center{};  ///< weighted by area
  Vector3 normal{};  ///< sum of the face normals, as long as the area
  double area = 0;
  double radius = 0;  ///< of a sphere about the center that holds everything
};

Vector3 vertex(const TriangleView& mesh, std::uint32_t index) {
  const double* p = &mesh.positions[3 * std::size_t{index}];
  return {p[0], p[1], p[2]};
}

Shape measure(const TriangleView& mesh) {
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

Vector3 face_normal(const TriangleView& mesh, std::size_t face) {
  const std::uint32_t* f = &mesh.faces[3 * face];
  const Vector3 a = vertex(mesh, f[0]);
  return 0.5 * cross(vertex(mesh, f[1]) - a, vertex(mesh, f[2]) - a);
}

/// One weight per face, 1 + kBending in total: its area, and how far its corners' normals turn.
std::vector<float> face_weights(const TriangleView& mesh) {
  std::vector<Vector3> normals(mesh.vertex_count(), Vector3{});
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    const Vector3 normal = face_normal(mesh, i);
    for (std::size_t k = 0; k < 3; ++k) {
      Vector3& sum = normals[mesh.faces[3 * i + k]];
      sum = sum + normal;
    }
  }
  std::vector<float> areas(mesh.face_count()), bendings(mesh.face_count());
  double total_area = 0, total_bending = 0;
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    const Vector3 normal = face_normal(mesh, i);
    const double area = norm(normal);
    double turn = 0;
    for (std::size_t k = 0; k < 3 && area > 0; ++k) {
      const Vector3 corner = normalized(normals[mesh.faces[3 * i + k]], {0, 0, 0});
      turn += 1 - dot(corner, normal) / area;
    }
    areas[i] = static_cast<float>(area);
    bendings[i] = static_cast<float>(area * turn);
    total_area += area;
    total_bending += area * turn;
  }
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const double area = total_area > 0 ? areas[i] / total_area : 0;
    const double bending = total_bending > 0 ? bendings[i] / total_bending : 0;
    areas[i] = static_cast<float>(area + kBending * bending);
  }
  return areas;
}

/// What a view shows of the front, less half of what it shows of the back.
double score(const TriangleView& mesh, const Shape& shape, const std::vector<float>& weights,
             const View& view) {
  std::vector<float> depths(kProbeSize * kProbeSize, -std::numeric_limits<float>::infinity());
  std::vector<bool> backs(depths.size(), false);
  const double scale = shape.radius > 0 ? kProbeSize / (2 * shape.radius) : 0;
  const auto project = [&](std::uint32_t index) {
    const Vector3 p = scale * (vertex(mesh, index) - shape.center);
    return Point{dot(p, view.right) + kProbeSize / 2.0, kProbeSize / 2.0 - dot(p, view.up),
                 dot(p, view.toward)};
  };
  std::vector<Point> points(mesh.vertex_count());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = project(std::uint32_t(i));
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    const Point &a = points[mesh.faces[i]], &b = points[mesh.faces[i + 1]],
                &c = points[mesh.faces[i + 2]];
    // The canvas has y down, which turns the orientation round.
    const bool back = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
    visit_triangle(a, b, c, kProbeSize, kProbeSize, [&](int x, int y, const Weights& w) {
      const auto depth = static_cast<float>(w[0] * a.depth + w[1] * b.depth + w[2] * c.depth);
      const std::size_t at = static_cast<std::size_t>(y) * kProbeSize + static_cast<std::size_t>(x);
      if (depth < depths[at]) return;
      depths[at] = depth;
      backs[at] = back;
    });
  }
  double total = 0;
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    const Point &a = points[mesh.faces[3 * i]], &b = points[mesh.faces[3 * i + 1]],
                &c = points[mesh.faces[3 * i + 2]];
    const int x = static_cast<int>((a.x + b.x + c.x) / 3),
              y = static_cast<int>((a.y + b.y + c.y) / 3);
    if (x < 0 || y < 0 || x >= kProbeSize || y >= kProbeSize) continue;
    const Vector3 normal = normalized(face_normal(mesh, i), {0, 0, 0});
    // Two samples of slack: a sloping face and its sample differ in depth.
    const double depth = (a.depth + b.depth + c.depth) / 3 + 2;
    const float nearest = depths[static_cast<std::size_t>(y * kProbeSize + x)];
    if (depth >= nearest) total += weights[i] * std::max(0.0, dot(normal, view.toward));
  }
  const double sample_share = shape.area > 0 && scale > 0 ? 1 / (scale * scale * shape.area) : 0;
  return total -
         0.5 * sample_share * static_cast<double>(std::count(backs.begin(), backs.end(), true));
}

/// Models stand on y or, less often, lie with z up. A boundary below the rest, as of a bust, tells.
Vector3 guess_up(const TriangleView& mesh, const Shape& shape,
                 const std::vector<Vector3>& boundary) {
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

View choose_view(const TriangleView& mesh, const std::vector<Vector3>& boundary) {
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
  const std::vector<float> weights = face_weights(mesh);
  View best = candidates.front();
  double best_score = -std::numeric_limits<double>::infinity();
  for (const View& candidate : candidates) {
    const double found = score(mesh, shape, weights, candidate);
    if (found > best_score) {
      best_score = found;
      best = candidate;
    }
  }
  return best;
}

}  // namespace beltrami::cli
