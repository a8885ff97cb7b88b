#include "ring/ring_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/portable_math.h"
#include "ring/triangulate_ring.h"

namespace beltrami {
namespace {

/// Weight of the whole scaffold against the mesh. It is laid at rest anew before each step, so it
/// pulls nowhere and only damps the steps: with 0.01 parts of the boundary run into each other and
/// stick, ending 0.1% to 3% higher; with 10 and more the steps become many and small.
constexpr double kScaffoldWeight = 1;
constexpr double kCircleFactor = 1.5;  // radius over half the diagonal of the bounding box
constexpr int kCirclePoints = 48;
/// Of the circle over the distance of its centre from the origin: below it the circle's points
/// would round onto each other.
constexpr double kLeastRadius = 1e-9;
/// Scaffold faces flatter than this (height over longest edge) weigh less in proportion: boundary
/// vertices in a line would be frozen by slivers that resist any relative move.
constexpr double kSliver = 0.05;

RestTriangle lay_flat(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 e1 = b - a, e2 = c - a;
  const double x1 = e1.norm();
  return {x1, e1.dot(e2) / x1, (e1.x() * e2.y() - e1.y() * e2.x()) / x1};
}

}  // namespace

std::vector<Vec2> circle_around(const std::vector<Vec2>& inner, double factor, int count) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : inner) box.extend(p);
  const double radius = std::max(factor * 0.5 * box.diagonal().norm(),
                                 kLeastRadius * box.center().cwiseAbs().maxCoeff());
  std::vector<Vec2> circle;
  circle.reserve(count);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    circle.push_back(box.center() + radius * Vec2(portable::cos(angle), portable::sin(angle)));
  }
  return circle;
}

std::vector<Vec2> scaffold_circle(const std::vector<Vec2>& inner) {
  return circle_around(inner, kCircleFactor, kCirclePoints);
}

void glue_ring(const std::vector<Triangle>& ring, const std::vector<Index>& boundary,
               Index first_outer, std::vector<Triangle>& faces) {
  const Index inner = size_of(boundary);
  faces.reserve(faces.size() + ring.size());
  for (Triangle t : ring) {
    for (Index& v : t) v = v < inner ? boundary[v] : first_outer + v - inner;
    faces.push_back(t);
  }
}

RingFaces ring_faces(const std::vector<Vec2>& polygon, double mesh_area) {
  RingFaces result;
  result.circle = scaffold_circle(polygon);
  const RingTriangulation ring = triangulate_ring(polygon, result.circle);
  double ring_area = 0;
  for (const Triangle& t : ring.faces) {
    const RestTriangle r = lay_flat(ring.points[t[0]], ring.points[t[1]], ring.points[t[2]]);
    // A face without area in floating point, though positive exactly, cannot serve as a shape.
    if (!(r.y2 > 0) || !(r.x1 > 0) || !std::isfinite(r.y2)) continue;
    result.faces.push_back(t);
    result.rest.push_back(r);
    ring_area += r.area();
  }
  for (const RestTriangle& r : result.rest) {
    const double longest =
        std::max({r.x1, portable::hypot(r.x2, r.y2), portable::hypot(r.x2 - r.x1, r.y2)});
    const double flatness = 2 * r.area() / (longest * longest);
    result.weights.push_back(kScaffoldWeight * mesh_area * r.area() / ring_area *
                             std::min(1.0, flatness / kSliver));
  }
  return result;
}

}  // namespace beltrami
