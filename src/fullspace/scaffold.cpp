#include "fullspace/scaffold.h"

#include <algorithm>
#include <cmath>

#include "distortion/symmetric_dirichlet.h"
#include "exact/certificate.h"
#include "fullspace/newton_step.h"
#include "scaffold/triangulate_ring.h"

namespace beltrami {
namespace {

/// Weight of the whole scaffold against the mesh: a barrier, not a shape. 0.01 costs 0.05% to 0.7%
/// in energy where parts of the boundary touch.
constexpr double kScaffoldWeight = 0.01;
constexpr double kCircleFactor = 1.5;  // radius over half the diagonal of the bounding box
constexpr int kCirclePoints = 48;
/// Scaffold faces flatter than this (height over longest edge) weigh less in proportion: boundary
/// vertices in a line would be frozen by slivers that resist any relative move.
constexpr double kSliver = 0.05;
constexpr double kFullStep = 0.5;
constexpr int kPatience = 5;  // short steps with little gain before it ends

/// The mesh and its scaffold as one triangulation of a circle.
struct Surrounded {
  std::vector<Triangle> faces;
  std::vector<RestTriangle> rest;
  std::vector<double> weights;
  std::vector<bool> fixed;
  std::vector<Vec2> uvs;
};

RestTriangle lay_flat(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 e1 = b - a, e2 = c - a;
  const double x1 = e1.norm();
  return {x1, e1.dot(e2) / x1, (e1.x() * e2.y() - e1.y() * e2.x()) / x1};
}

Surrounded surround(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const std::vector<Vec2>& uvs) {
  std::vector<Vec2> inner;
  for (const Index v : mesh.boundary) inner.push_back(uvs[v]);
  const auto outer = circle_around(inner, kCircleFactor, kCirclePoints);
  const RingTriangulation ring = triangulate_ring(inner, outer);

  Surrounded all{mesh.faces, rest, {}, std::vector<bool>(uvs.size(), false), uvs};
  double mesh_area = 0;
  for (const RestTriangle& r : rest) {
    all.weights.push_back(r.area());
    mesh_area += r.area();
  }
  all.uvs.insert(all.uvs.end(), outer.begin(), outer.end());
  all.fixed.resize(all.uvs.size(), true);
  const auto vertex = [&](Index i) {
    return i < size_of(inner) ? mesh.boundary[i] : size_of(uvs) + i - size_of(inner);
  };
  double ring_area = 0;
  for (const Triangle& t : ring.faces) {
    const RestTriangle r =
        lay_flat(ring.points[t[0]], ring.points[t[1]], ring.points[t[2]]);
    // A face without area in floating point, though positive exactly, cannot serve as a shape.
    if (!(r.y2 > 0) || !(r.x1 > 0) || !std::isfinite(r.y2)) continue;
    all.faces.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
    all.rest.push_back(r);
    ring_area += r.area();
  }
  for (std::size_t f = rest.size(); f < all.rest.size(); ++f) {
    const RestTriangle& r = all.rest[f];
    const double longest = std::max({r.x1, std::abs(r.corner(2)), std::abs(r.corner(2) - r.x1)});
    const double flatness = 2 * r.area() / (longest * longest);
    all.weights.push_back(kScaffoldWeight * mesh_area * r.area() / ring_area *
                          std::min(1.0, flatness / kSliver));
  }
  return all;
}

double mesh_energy(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                   const std::vector<Vec2>& uvs) {
  double sum = 0, area = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& t = mesh.faces[f];
    const SingularValues s = singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
    sum += rest[f].area() * SymmetricDirichlet::value(s.s1, s.s2);
    area += rest[f].area();
  }
  return sum / area;
}

}  // namespace

NewtonResult minimise_with_scaffold(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                    std::vector<Vec2>& uvs, const NewtonOptions& options,
                                    const Checkpoint& checkpoint) {
  NewtonResult result;
  result.energies.push_back(mesh_energy(mesh, rest, uvs));
  int little_gain = 0;
  while (!result.converged && result.iterations() < options.max_iterations) {
    checkpoint(result.iterations() / (result.iterations() + 12.0));
    Surrounded all = surround(mesh, rest, uvs);
    NewtonStepper<SymmetricDirichlet> stepper(all.faces, all.rest, all.weights, mesh.face_count(),
                                              all.fixed, options.threads);
    stepper.set_accept([&](const std::vector<Vec2>& trial) {
      return count_crossings(mesh.boundary, trial).count == 0;
    });
    const NewtonStep step = stepper.step(all.uvs, stepper.mean_energy(all.uvs));
    if (step.length == 0) break;
    std::copy_n(all.uvs.begin(), uvs.size(), uvs.begin());
    const double before = result.energies.back();
    result.energies.push_back(mesh_energy(mesh, rest, uvs));
    const bool little = before - result.energies.back() <= options.tolerance * before;
    little_gain = little ? little_gain + 1 : 0;
    result.converged = (little && step.length >= kFullStep) || little_gain >= kPatience;
  }
  return result;
}

}  // namespace beltrami
