// Boundary first flattening: exact where the metric is flat, conformal where it is not, closed
// always.
#include "baselines/boundary_first.h"
#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "support/meshes.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

struct Problem {
  explicit Problem(const TriangleList& list, Complex mu = 0)
      : mesh(build_disk(list.positions, list.faces, Work(1))),
        rest(rest_triangles(mesh.positions, mesh.faces, Work(1))),
        metric(mesh.faces.size()) {
    for (FaceMetric& m : metric) m.mu = mu;
  }

  BoundaryFirstResult flatten(const std::vector<double>& lengths) const {
    return flatten_boundary_first(mesh, rest, metric, lengths, Work(1));
  }
  BoundaryFirstResult flatten() const {
    return flatten(metric_boundary_lengths(mesh, rest, metric));
  }

  DiskMesh mesh;
  std::vector<RestTriangle> rest;
  std::vector<FaceMetric> metric;
};

/// Boundary edge i of a map, from boundary[i] to boundary[i + 1].
Vec2 boundary_edge(const DiskMesh& mesh, const std::vector<Vec2>& uvs, std::size_t i) {
  return uvs[mesh.boundary[(i + 1) % mesh.boundary.size()]] - uvs[mesh.boundary[i]];
}

/// The greatest distance from `expected` after the rigid motion that aligns the first boundary
/// edge.
double deviation(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                 const std::vector<Vec2>& expected) {
  const auto complex = [](const Vec2& w) { return Complex(w.x(), w.y()); };
  const Index from = mesh.boundary[0];
  const Complex turn =
      complex(boundary_edge(mesh, expected, 0)) / complex(boundary_edge(mesh, uvs, 0));
  double greatest = std::abs(std::abs(turn) - 1);
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    const Complex moved = complex(expected[from]) + turn * complex(uvs[v] - uvs[from]);
    greatest = std::max(greatest, std::abs(moved - complex(expected[v])));
  }
  return greatest;
}

std::vector<Vec2> drop_height(const std::vector<Vec3>& positions) {
  std::vector<Vec2> plane;
  for (const Vec3& p : positions) plane.push_back(p.head<2>());
  return plane;
}

/// A flat disk whose interior has no symmetry and whose boundary is not convex.
TriangleList crooked_disk() {
  TriangleList list = meshes::grid(9, 7);
  for (Vec3& p : list.positions) {
    const double x = p.x(), y = p.y();
    p.x() += 0.2 * y * y + 0.02 * portable::sin(9 * x + 4 * y);
    p.y() += 0.3 * portable::sin(3 * x);
  }
  return list;
}

TEST(BoundaryFirst, ReproducesAFlatDisk) {
  for (const TriangleList& list :
       {crooked_disk(), meshes::fan(5), meshes::triangle(), meshes::strip(6)}) {
    const Problem problem(list);
    const BoundaryFirstResult result = problem.flatten();
    EXPECT_LT(result.closure_defect, 1e-10);
    EXPECT_LT(deviation(problem.mesh, result.uvs, drop_height(list.positions)), 1e-8);
  }
}

TEST(BoundaryFirst, UnrollsADevelopableSurface) {
  TriangleList list = meshes::grid(8, 6);
  const std::vector<Vec2> plane = drop_height(list.positions);
  // Chords of a polygonal cylinder: the cells stay rectangles of their own width.
  for (Vec3& p : list.positions) {
    const double angle = 4 * p.x(), width = 0.5 / (8 * portable::sin(0.25));
    p = {width * portable::cos(angle) / 2, p.y(), -width * portable::sin(angle) / 2};
  }
  const Problem problem(list);
  const BoundaryFirstResult result = problem.flatten();
  EXPECT_LT(result.closure_defect, 1e-10);
  std::vector<Vec2> expected = plane;
  const double cell = (list.positions[1] - list.positions[0]).norm();
  for (Vec2& w : expected) w.x() *= 8 * cell;
  EXPECT_LT(deviation(problem.mesh, result.uvs, expected), 1e-8);
}

TEST(BoundaryFirst, ReproducesTheAffineMapOfAConstantMetric) {
  // mu is constant in the plane, and turned into the frame of each face, which lies along its edge.
  const Complex mu(0.3, -0.4);
  const double fz = 1.7;
  const TriangleList list = crooked_disk();
  Problem problem(list);
  for (std::size_t f = 0; f < problem.metric.size(); ++f) {
    const Triangle& t = list.faces[f];
    const Vec3 edge = list.positions[t[1]] - list.positions[t[0]];
    const Complex along = Complex(edge.x(), edge.y()) / edge.norm();
    problem.metric[f].mu = mu * std::conj(along * along);
    problem.metric[f].log_area = std::log(fz * fz * (1 - std::norm(mu)));
  }
  std::vector<Vec2> expected;
  for (const Vec3& p : list.positions) {
    const Complex z(p.x(), p.y()), w = fz * (z + mu * std::conj(z));
    expected.emplace_back(w.real(), w.imag());
  }
  const BoundaryFirstResult result = problem.flatten();
  EXPECT_LT(result.closure_defect, 1e-10);
  EXPECT_LT(deviation(problem.mesh, result.uvs, expected), 1e-8);
}

TEST(BoundaryFirst, FlattensASphericalCapConformally) {
  const Problem problem(meshes::cap(24, 96, 1.0));
  const auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
  const BoundaryFirstResult result = problem.flatten(lengths);
  EXPECT_LT(result.closure_defect, 1e-10);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    EXPECT_NEAR(boundary_edge(problem.mesh, result.uvs, i).norm() / lengths[i], 1, 1e-9);
  }
  for (Index f = 0; f < problem.mesh.face_count(); ++f) {
    const Triangle& t = problem.mesh.faces[f];
    const LinearMap map =
        linear_map(problem.rest[f], result.uvs[t[0]], result.uvs[t[1]], result.uvs[t[2]]);
    EXPECT_LT(std::abs(map.fzbar / map.fz), 0.02) << "face " << f;
  }
}

TEST(BoundaryFirst, IsStereographicOnASphericalCap) {
  // The conformal map of a cap is known: radius 2 tan(angle / 2) up to a factor.
  constexpr Index kRings = 24, kSectors = 96;
  const Problem problem(meshes::cap(kRings, kSectors, 1.0));
  const BoundaryFirstResult result = problem.flatten();
  const Vec2& pole = result.uvs[0];
  const double rim = (result.uvs[1 + (kRings - 1) * kSectors] - pole).norm();
  for (Index ring = 1; ring < kRings; ++ring) {
    const double radius = (result.uvs[1 + (ring - 1) * kSectors] - pole).norm();
    const double expected = rim * std::tan(0.5 * ring / kRings) / std::tan(0.5);
    EXPECT_NEAR(radius / expected, 1, 0.01) << "ring " << ring;
  }
}

TEST(BoundaryFirst, ClosesAnyCurveWithPositiveLengths) {
  for (const TriangleList& list :
       {meshes::bumps(9, 8), meshes::cap(6, 12, 2.6), crooked_disk(), meshes::strip(7)}) {
    const Problem problem(list);
    auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      lengths[i] *= portable::exp(0.5 * portable::sin(static_cast<double>(i)));
    }
    const BoundaryFirstResult result = problem.flatten(lengths);
    // Closed by factors exp(-slope . tangent): were the curve left open, the last edge, which takes
    // all that is missing, would not follow the law of the others.
    const std::size_t count = lengths.size();
    Eigen::MatrixX2d tangents(count, 2);
    Eigen::VectorXd logs(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 edge = boundary_edge(problem.mesh, result.uvs, i);
      ASSERT_GT(edge.norm(), 0);
      tangents.row(static_cast<Eigen::Index>(i)) = edge.normalized().transpose();
      logs(static_cast<Eigen::Index>(i)) = std::log(edge.norm() / lengths[i]);
    }
    const Eigen::Matrix2d normal = tangents.transpose() * tangents;
    const Vec2 slope = normal.inverse() * (tangents.transpose() * logs);
    EXPECT_LT((logs - tangents * slope).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT(result.closure_defect, 0.5);
  }
}

TEST(BoundaryFirst, StaysFiniteWhereNoLengthsWouldClose) {
  // Lengths that violate the triangle inequality by six orders of magnitude.
  const Problem problem(meshes::fan(3));
  const BoundaryFirstResult result = problem.flatten({1e-6, 1, 1e6});
  EXPECT_TRUE(std::isfinite(result.closure_defect));
  for (const Vec2& w : result.uvs) EXPECT_TRUE(w.allFinite());
}

TEST(BoundaryFirst, KeepsAnEarOpenWhereTheMetricJumps) {
  // The mean length of the diagonal is longer than both other edges of the second face together.
  Problem problem(meshes::quad());
  problem.metric[0].log_area = 4;
  const BoundaryFirstResult result = problem.flatten();
  for (Index f = 0; f < 2; ++f) {
    const Triangle& t = problem.mesh.faces[f];
    const Vec2 a = result.uvs[t[1]] - result.uvs[t[0]], b = result.uvs[t[2]] - result.uvs[t[0]];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.1) << "face " << f;
  }
}

TEST(BoundaryFirst, ScalesWithTheLengthsAndNotWithTheMesh) {
  const TriangleList list = meshes::bumps(8, 8);
  const Problem problem(list);
  auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
  const BoundaryFirstResult once = problem.flatten(lengths);

  for (double& length : lengths) length *= 1e3;
  const BoundaryFirstResult longer = problem.flatten(lengths);
  TriangleList large = list;
  for (Vec3& p : large.positions) p *= 1e5;
  const BoundaryFirstResult larger = Problem(large).flatten(lengths);
  EXPECT_NEAR(longer.closure_defect, once.closure_defect, 1e-9);
  EXPECT_NEAR(larger.closure_defect, once.closure_defect, 1e-9);
  for (std::size_t v = 0; v < once.uvs.size(); ++v) {
    EXPECT_LT((longer.uvs[v] / 1e3 - once.uvs[v]).norm(), 1e-9);
    EXPECT_LT((larger.uvs[v] / 1e3 - once.uvs[v]).norm(), 1e-9);
  }
}

TEST(BoundaryFirst, MetricLengthsAreThoseOfTheMapThatHasTheMetric) {
  const TriangleList list = meshes::bumps(5, 4);
  Problem problem(list);
  std::vector<Vec2> uvs = drop_height(list.positions);
  for (Vec2& w : uvs) w.x() += 0.3 * w.y() * w.y();
  problem.metric = face_metrics(problem.mesh.faces, problem.rest, uvs);
  const auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
  ASSERT_EQ(lengths.size(), problem.mesh.boundary.size());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    EXPECT_NEAR(lengths[i], boundary_edge(problem.mesh, uvs, i).norm(), 1e-12);
  }
}

TEST(BoundaryFirst, ReproducesAMapFromItsOwnMetric) {
  const TriangleList list = meshes::bumps(30, 30);
  Problem problem(list);
  std::vector<Vec2> uvs = drop_height(list.positions);
  for (Vec2& w : uvs) w = {w.x() + 0.2 * w.y() * w.y(), w.y() + 0.1 * portable::sin(3 * w.x())};
  problem.metric = face_metrics(problem.mesh.faces, problem.rest, uvs);
  const BoundaryFirstResult result = problem.flatten();
  EXPECT_LT(result.closure_defect, 1e-10);
  EXPECT_LT(deviation(problem.mesh, result.uvs, uvs), 1e-8);
}

/// How far the map is from its own when the metric keeps its mu, but loses its area factors, for
/// which the lengths of the boundary have to make up.
double error_without_area_factors(Index n) {
  const TriangleList list = meshes::bumps(n, n);
  Problem problem(list);
  std::vector<Vec2> uvs = drop_height(list.positions);
  for (Vec2& w : uvs) w = {w.x() + 0.2 * w.y() * w.y(), w.y() + 0.1 * portable::sin(3 * w.x())};
  problem.metric = face_metrics(problem.mesh.faces, problem.rest, uvs);
  const auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
  for (FaceMetric& m : problem.metric) m.log_area = 0;
  return deviation(problem.mesh, problem.flatten(lengths).uvs, uvs);
}

TEST(BoundaryFirst, ConvergesFromTheConformalClassAlone) {
  const double coarse = error_without_area_factors(20), fine = error_without_area_factors(80);
  EXPECT_LT(fine, 0.02);
  EXPECT_LT(fine, 0.4 * coarse);
}

TEST(BoundaryFirst, StopsAtEveryReport) {
  const Problem problem(meshes::bumps(4, 4));
  const auto lengths = metric_boundary_lengths(problem.mesh, problem.rest, problem.metric);
  int calls = 0;
  double last = -1;
  flatten_boundary_first(problem.mesh, problem.rest, problem.metric, lengths,
                         Work({}, [&](double fraction, const char*) {
                           EXPECT_GT(fraction, last);
                           EXPECT_LE(fraction, 1);
                           last = fraction;
                           ++calls;
                           return false;
                         }));
  EXPECT_GE(calls, 4);
  for (int stop = 1; stop <= calls; ++stop) {
    int call = 0;
    EXPECT_THROW(
        flatten_boundary_first(problem.mesh, problem.rest, problem.metric, lengths,
                               Work({}, [&](double, const char*) { return ++call == stop; })),
        Cancelled);
  }
}

}  // namespace
}  // namespace beltrami
