// The fine map: boundary carried over, harmonic and metric solves, polish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/polish.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"
#include "simplify/coarse.h"
#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;

double greatest_distance(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double greatest = 0;
  for (std::size_t v = 0; v < a.size(); ++v) greatest = std::max(greatest, (a[v] - b[v]).norm());
  return greatest;
}

// ---- Boundary -------------------------------------------------------------------------------

/// Two fine cells by two on the unit square, and the coarse square of its corners.
struct Square {
  DiskMesh fine = disks::disk(meshes::grid(2, 2));
  CoarseDisk coarse{
      build_disk({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 3}, {0, 3, 2}}, Work(1)),
      {0, 2, 6, 8},
      {0, 0, 1, 0, 0, 1, 2, 2, 3}};
};

TEST(CarryBoundary, KeepsSurvivorsAndPutsTheOthersOnTheSegmentByArcLength) {
  Square square;
  square.fine.positions[1].x() = 0.25;  // a quarter along the bottom
  const std::vector<Vec2> coarse_uvs = {{1, 1}, {9, 1}, {1, 5}, {9, 5}};
  const auto uvs = carry_boundary(square.fine, square.coarse, coarse_uvs);
  for (int v = 0; v < 4; ++v) EXPECT_EQ(uvs[square.coarse.fine_vertex[v]], coarse_uvs[v]);
  EXPECT_EQ(uvs[1], Vec2(3, 1));
  EXPECT_EQ(uvs[5], Vec2(9, 3));
  EXPECT_EQ(uvs[7], Vec2(5, 5));
  EXPECT_EQ(uvs[3], Vec2(1, 3));
  EXPECT_EQ(uvs[4], Vec2(0, 0));
}

TEST(CarryBoundary, MeasuresArcLengthAlongTheFineBoundary) {
  Square square;
  // The bottom now detours: length 1/2 down to vertex 1, then sqrt(5)/2 up to vertex 2.
  square.fine.positions[1] = {0, -0.5, 0};
  const auto uvs = carry_boundary(square.fine, square.coarse, {{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  EXPECT_NEAR(uvs[1].x(), 0.5 / (0.5 + std::sqrt(1.25)), 1e-15);
}

TEST(CarryBoundary, SpreadsVerticesEvenlyWhereTheBoundaryHasNoLength) {
  Square square;
  for (const Index v : {1, 2}) square.fine.positions[v] = square.fine.positions[0];
  const auto uvs = carry_boundary(square.fine, square.coarse, {{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  EXPECT_EQ(uvs[1], Vec2(0.5, 0));
}

TEST(CarryBoundary, KeepsTheOrderAndASimplePolygon) {
  const DiskMesh fine = disks::disk(meshes::cap(12, 60, 1.3));
  const CoarseDisk coarse = simplify(fine, 200, Work(1));
  ASSERT_LT(coarse.mesh.boundary.size(), fine.boundary.size());
  const std::vector<Vec2> coarse_uvs = tutte_embedding(coarse.mesh, Work(1));
  const auto uvs = carry_boundary(fine, coarse, coarse_uvs);
  EXPECT_EQ(count_crossings(fine.boundary, uvs).count, 0);
  double turned = 0;
  for (std::size_t i = 0; i < fine.boundary.size(); ++i) {
    const Vec2 &a = uvs[fine.boundary[i]], &b = uvs[fine.boundary[(i + 1) % fine.boundary.size()]];
    const double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    EXPECT_GT(angle, 0);
    turned += angle;
  }
  EXPECT_NEAR(turned, 2 * 3.14159265358979, 1e-9);
}

// ---- Cotangents -----------------------------------------------------------------------------

double cotangent(Complex apex, Complex a, Complex b) {
  const Complex q = (b - apex) * std::conj(a - apex);
  return q.real() / q.imag();
}

TEST(ModifiedCotangents, AreThoseOfTheDeformedTriangle) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const RestTriangle rest{random.between(0.1, 2), random.between(-1, 2), random.between(0.1, 2)};
    const Complex k = i == 0 ? 0.0 : std::polar(0.98 * random.unit(), random.between(0, 6.28));
    const auto cotangents = modified_cotangents(rest, k);
    const auto corner = [&](int c) { return rest.corner(c) + k * std::conj(rest.corner(c)); };
    for (int c = 0; c < 3; ++c) {
      const double expected =
          cotangent(corner(c), corner(next_corner(c)), corner(previous_corner(c)));
      EXPECT_NEAR(cotangents[c], expected, 1e-10 * (1 + std::abs(expected)));
    }
  }
}

TEST(ModifiedCotangents, AreKnownForARightTriangle) {
  const auto c = modified_cotangents({1, 0, 1}, 0);
  EXPECT_NEAR(c[0], 0, 1e-15);
  EXPECT_NEAR(c[1], 1, 1e-15);
  EXPECT_NEAR(c[2], 1, 1e-15);
}

// ---- Harmonic solve -------------------------------------------------------------------------

/// A flat grid with its interior vertices shaken, so that its faces differ.
DiskMesh uneven_grid(Index n) {
  Random random(2);
  meshes::TriangleList list = meshes::grid(n, n);
  const DiskMesh even = disks::disk(list);
  for (Index v = 0; v < even.vertex_count(); ++v) {
    if (even.on_boundary[v]) continue;
    const Vec2 shift = 0.25 / n * random.vec2();
    list.positions[v] += Vec3(shift.x(), shift.y(), 0);
  }
  return disks::disk(list);
}

/// Keeps the boundary of `uvs` and moves all interior vertices to the origin.
std::vector<Vec2> boundary_only(const DiskMesh& mesh, std::vector<Vec2> uvs) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.on_boundary[v]) uvs[v] = Vec2::Zero();
  }
  return uvs;
}

std::vector<Cotangents> plain_cotangents(const DiskMesh& mesh) {
  return modified_cotangents(disks::rest_of(mesh), std::vector<FaceMetric>(mesh.faces.size()),
                             Work(1));
}

TEST(SolveHarmonic, ReproducesLinearMapsWithoutACoefficient) {
  const DiskMesh mesh = uneven_grid(9);
  std::vector<Vec2> expected = disks::flat_uvs(mesh);
  for (Vec2& w : expected) w = {2 * w.x() - w.y() + 3, 0.5 * w.x() + 4 * w.y()};
  std::vector<Vec2> uvs = boundary_only(mesh, expected);
  solve_harmonic(mesh, plain_cotangents(mesh), uvs, Work(1));
  EXPECT_LE(greatest_distance(uvs, expected), 1e-10);
}

TEST(SolveHarmonic, ReproducesTheAffineMapOfItsCoefficient) {
  const DiskMesh mesh = uneven_grid(9);
  const auto rest = disks::rest_of(mesh);
  for (const Complex k : {Complex(0.5, 0), Complex(-0.3, 0.6), Complex(0, -0.9)}) {
    const std::vector<Vec2> expected = disks::affine_uvs(mesh, k);
    std::vector<Vec2> uvs = boundary_only(mesh, expected);
    solve_harmonic(mesh,
                   modified_cotangents(rest, face_metrics(mesh.faces, rest, expected), Work(1)),
                   uvs, Work(1));
    EXPECT_LE(greatest_distance(uvs, expected), 1e-10);
  }
}

// The coefficient of a map that is not affine makes the solve differ from the plain one: the
// piecewise linear map itself is a solution, because it is conformal in its own metric.
TEST(SolveHarmonic, ReproducesAnyMapFromItsOwnCoefficients) {
  const DiskMesh mesh = disks::disk(meshes::cap(8, 20, 2.2));
  const auto rest = disks::rest_of(mesh);
  const std::vector<Vec2> expected = tutte_embedding(mesh, Work(1));
  std::vector<Vec2> uvs = boundary_only(mesh, expected);
  solve_harmonic(mesh, modified_cotangents(rest, face_metrics(mesh.faces, rest, expected), Work(1)),
                 uvs, Work(1));
  EXPECT_LE(greatest_distance(uvs, expected), 1e-9);
  std::vector<Vec2> plain = boundary_only(mesh, expected);
  solve_harmonic(mesh, plain_cotangents(mesh), plain, Work(1));
  EXPECT_GT(greatest_distance(plain, expected), 1e-3);
}

TEST(SolveHarmonic, LeavesADiskWithoutInteriorVerticesAsItIs) {
  const DiskMesh mesh = disks::disk(meshes::strip(5));
  const std::vector<Vec2> expected = disks::affine_uvs(mesh, 0.4);
  std::vector<Vec2> uvs = expected;
  solve_harmonic(mesh, plain_cotangents(mesh), uvs, Work(1));
  EXPECT_EQ(uvs, expected);
}

// ---- Metric solve ---------------------------------------------------------------------------

std::vector<EdgeWeights> stiffness_of(const std::vector<RestTriangle>& rest,
                                      const std::vector<FaceMetric>& metric) {
  return energy_stiffness(Energy::kSymmetricDirichlet, rest, metric, Work(1));
}

std::vector<Vec2> solve_from_own_metric(const DiskMesh& mesh, const std::vector<Vec2>& map,
                                        const std::vector<bool>& held) {
  const auto rest = disks::rest_of(mesh);
  const auto metric = face_metrics(mesh.faces, rest, map);
  const auto stiffness = stiffness_of(rest, metric);
  const MetricLaplacian laplacian(mesh, stiffness, held, {Precision::kSingle}, {}, Work(1));
  std::vector<Vec2> uvs(map.size(), Vec2::Zero());
  for (std::size_t v = 0; v < map.size(); ++v) {
    if (held[v]) uvs[v] = map[v];
  }
  solve_metric(mesh, rest, metric, stiffness, laplacian, {}, false, uvs, Work(1));
  return uvs;
}

TEST(SolveMetric, ReproducesAnyMapFromItsOwnMetric) {
  for (const auto& list : {meshes::cap(8, 20, 2.2), meshes::strip(8), meshes::triangle(),
                           disks::slivers(6, 6), disks::degenerate_faces(8)}) {
    const DiskMesh mesh = disks::disk(list);
    const std::vector<Vec2> map = tutte_embedding(mesh, Work(1));
    const auto uvs = solve_from_own_metric(mesh, map, disks::only_fixed(mesh, 0));
    EXPECT_LE(greatest_distance(uvs, map), 1e-6 * std::sqrt(surface_area(mesh, Work(1))));
  }
}

// The phases of a prolonged metric are only roughly right: the rotations are fitted again.
TEST(SolveMetric, RecoversTheMapFromPhasesThatAreOff) {
  Random random(5);
  const DiskMesh mesh = disks::disk(meshes::grid(8, 8));
  const auto rest = disks::rest_of(mesh);
  auto metric = face_metrics(mesh.faces, rest, disks::flat_uvs(mesh));
  for (FaceMetric& m : metric) m.phase *= std::polar(1.0, random.between(-0.5, 0.5));
  const auto stiffness = stiffness_of(rest, metric);
  const MetricLaplacian laplacian(mesh, stiffness, disks::only_fixed(mesh, 0), {Precision::kSingle},
                                  {}, Work(1));
  const auto energy_after = [&](int rotations) {
    std::vector<Vec2> uvs(mesh.positions.size(), Vec2::Zero());
    for (int round = 0; round <= rotations; ++round) {
      solve_metric(mesh, rest, metric, stiffness, laplacian, {}, round > 0, uvs, Work(1));
    }
    return measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(1))
               .symmetric_dirichlet -
           2;
  };
  const double none = energy_after(0);
  EXPECT_GT(none, 1e-3);
  EXPECT_LT(energy_after(2), 0.2 * none);
  EXPECT_LT(energy_after(30), 1e-6);
}

TEST(SolveMetric, DoesNotMoveHeldVertices) {
  Random random(3);
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 1.5));
  const std::vector<Vec2> map = disks::flat_uvs(mesh);
  std::vector<bool> held(mesh.positions.size());
  for (std::size_t v = 0; v < held.size(); ++v) held[v] = v == 0 || random.below(3) == 0;
  const auto uvs = solve_from_own_metric(mesh, map, held);
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (held[v]) {
      EXPECT_EQ(uvs[v], map[v]);
    }
  }
}

TEST(SolveMetric, HasTheSameBitsOnTwoThreads) {
  const DiskMesh mesh = disks::disk(meshes::bumps(70, 70));
  const auto rest = disks::rest_of(mesh);
  const auto metric = face_metrics(mesh.faces, rest, disks::flat_uvs(mesh));
  const auto stiffness = stiffness_of(rest, metric);
  EXPECT_EQ(stiffness, energy_stiffness(Energy::kSymmetricDirichlet, rest, metric, Work(2)));
  const MetricLaplacian laplacian(mesh, stiffness, disks::only_fixed(mesh, 0), {Precision::kSingle},
                                  {}, Work(1));
  std::vector<Vec2> one(mesh.positions.size(), Vec2::Zero()), two = one;
  for (const bool rotate : {false, true}) {
    solve_metric(mesh, rest, metric, stiffness, laplacian, {}, rotate, one, Work(1));
    solve_metric(mesh, rest, metric, stiffness, laplacian, {}, rotate, two, Work(2));
    EXPECT_EQ(one, two);
  }
}

// ---- Polish ---------------------------------------------------------------------------------

struct Polished {
  PolishResult result;
  std::vector<Vec2> uvs;
};

Polished polish_from(const DiskMesh& mesh, const std::vector<Vec2>& start,
                     const PolishOptions& options, int threads = 1) {
  const auto rest = disks::rest_of(mesh);
  const auto stiffness =
      energy_stiffness(options.energy, rest, face_metrics(mesh.faces, rest, start), Work(threads));
  const MetricLaplacian laplacian(mesh, stiffness, disks::only_fixed(mesh, mesh.boundary.front()),
                                  {Precision::kSingle}, {}, Work(threads));
  const double area = surface_area(mesh, Work(1));
  Polished polished{{}, start};
  polished.result = polish(
      mesh, rest,
      [&](const std::vector<Vec2>& in, std::vector<Vec2>& out) {
        laplacian.solve(in, out);
        for (Vec2& w : out) w *= area;
      },
      polished.uvs, options, Work(threads));
  return polished;
}

TEST(EnergyStiffness, OfAnIsometryIsTheCurvatureTimesTheLaplacian) {
  const DiskMesh mesh = disks::disk(meshes::bumps(6, 6));
  const auto rest = disks::rest_of(mesh);
  const auto stiffness = stiffness_of(rest, std::vector<FaceMetric>(rest.size()));
  for (std::size_t f = 0; f < rest.size(); ++f) {
    const Cotangents cotangents = modified_cotangents(rest[f], 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(stiffness[f][k], 4 * 0.5 * cotangents[k], 1e-12 * (1 + std::abs(cotangents[k])));
    }
  }
}

TEST(EnergyStiffness, OfAMapIsThatOfItsMetric) {
  const DiskMesh mesh = disks::disk(meshes::cap(6, 16, 1.5));
  const auto rest = disks::rest_of(mesh);
  const auto uvs = tutte_embedding(mesh, Work(1));
  const auto of_metric = stiffness_of(rest, face_metrics(mesh.faces, rest, uvs));
  const auto of_map = energy_stiffness(Energy::kSymmetricDirichlet, mesh.faces, rest, uvs, Work(2));
  for (std::size_t f = 0; f < rest.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const double size = std::abs(of_metric[f][0]) + std::abs(of_metric[f][1]);
      EXPECT_NEAR(of_map[f][k], of_metric[f][k], 1e-9 * size);
    }
  }
}

TEST(MetricLaplacian, RefittedSolvesForTheOtherStiffness) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  const auto rest = disks::rest_of(mesh);
  const auto held = disks::only_fixed(mesh, 0);
  std::vector<FaceMetric> metric(rest.size());
  const auto plain = stiffness_of(rest, metric);
  for (FaceMetric& m : metric) m.mu = Complex(0.3, 0.2);
  const auto other = stiffness_of(rest, metric);
  MetricLaplacian refitted(mesh, plain, held, {Precision::kSingle}, {}, Work(1));
  refitted.refit(other, {});
  const MetricLaplacian fresh(mesh, other, held, {Precision::kSingle}, {}, Work(1));
  const DenseMatrix rhs = DenseMatrix::Random(mesh.vertex_count(), 2);
  EXPECT_EQ(refitted.solve(rhs), fresh.solve(rhs));
  refitted.refit(plain, {});
  const auto in_parts = [&](std::int64_t first, std::int64_t end, EdgeWeights* weights) {
    std::copy(other.begin() + first, other.begin() + end, weights);
  };
  refitted.refit(in_parts, {});
  EXPECT_EQ(refitted.solve(rhs), fresh.solve(rhs));
}

TEST(Polish, NeverRaisesTheEnergyAndNeverFlips) {
  for (const auto& list : {meshes::bumps(10, 10), meshes::cap(8, 24, 1.8), meshes::strip(10),
                           disks::slivers(6, 6), disks::spike(8)}) {
    const DiskMesh mesh = disks::disk(list);
    for (const auto& [energy, history] :
         {std::pair(Energy::kSymmetricDirichlet, 5u), std::pair(Energy::kExponentialDirichlet, 5u),
          std::pair(Energy::kSymmetricDirichlet, 0u),
          std::pair(Energy::kExponentialDirichlet, 0u)}) {
      PolishOptions options;
      options.energy = energy;
      options.history = history;
      const Polished polished = polish_from(mesh, tutte_embedding(mesh, Work(1)), options);
      const auto& energies = polished.result.energies;
      ASSERT_GT(energies.size(), 1u);
      EXPECT_TRUE(std::is_sorted(energies.rbegin(), energies.rend()));
      EXPECT_LT(energies.back(), energies.front());
      EXPECT_TRUE(non_positive_faces(mesh.faces, polished.uvs, Work(1)).empty());
      const double measured =
          mean_energy(energy, mesh.faces, disks::rest_of(mesh), polished.uvs, Work(1));
      EXPECT_NEAR(energies.back(), measured, 1e-9 * measured);
    }
  }
}

TEST(Polish, ReachesTheIsometryOfAFlatGridNextToIt) {
  Random random(4);
  const DiskMesh mesh = disks::disk(meshes::grid(8, 8));
  std::vector<Vec2> start = disks::flat_uvs(mesh);
  for (Vec2& w : start) w += 0.02 * random.vec2();
  PolishOptions options;
  options.max_iterations = 200;
  options.tolerance = 1e-10;
  const Polished polished = polish_from(mesh, start, options);
  EXPECT_TRUE(polished.result.converged);
  EXPECT_NEAR(polished.result.energies.back(), 2, 1e-6);
}

TEST(Polish, KeepsToItsLimitOfSteps) {
  const DiskMesh mesh = disks::disk(meshes::bumps(10, 10));
  PolishOptions options;
  options.max_iterations = 3;
  EXPECT_LE(polish_from(mesh, tutte_embedding(mesh, Work(1)), options).result.iterations(), 3);
}

TEST(Polish, TakesTheSameFirstStepWithAndWithoutRememberingSteps) {
  const DiskMesh mesh = disks::disk(meshes::bumps(10, 10));
  const std::vector<Vec2> start = tutte_embedding(mesh, Work(1));
  PolishOptions options;
  options.max_iterations = 1;
  const std::vector<Vec2> remembered = polish_from(mesh, start, options).uvs;
  options.history = 0;
  EXPECT_EQ(polish_from(mesh, start, options).uvs, remembered);
  EXPECT_NE(remembered, start);
}

TEST(Polish, ContinuesTheStepOfTheCallBefore) {
  const DiskMesh mesh = disks::disk(meshes::bumps(40, 40));
  const std::vector<Vec2> start = tutte_embedding(mesh, Work(1));
  const auto energy_after = [&](int calls, bool continues, int threads) {
    LastStep last;
    PolishOptions options;
    options.max_iterations = 1;
    options.history = 0;
    options.last = continues ? &last : nullptr;
    Polished polished{{}, start};
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < calls; ++i) {
      polished = polish_from(mesh, polished.uvs, options, threads);
      EXPECT_LE(polished.result.energies.front(), before);
      before = polished.result.energies.back();
      EXPECT_TRUE(non_positive_faces(mesh.faces, polished.uvs, Work(1)).empty());
    }
    return before;
  };
  EXPECT_EQ(energy_after(1, true, 1), energy_after(1, false, 1));
  EXPECT_EQ(energy_after(6, true, 1), energy_after(6, true, 2));
  EXPECT_LT(energy_after(12, true, 1), energy_after(12, false, 1));
}

TEST(Polish, WithoutADescentAlongTheLastStepGoesOnWithoutIt) {
  const DiskMesh mesh = disks::disk(meshes::bumps(10, 10));
  const std::vector<Vec2> start = tutte_embedding(mesh, Work(1));
  PolishOptions options;
  options.max_iterations = 1;
  options.history = 0;
  const std::vector<Vec2> plain = polish_from(mesh, start, options).uvs;
  LastStep uphill{{}, 1};
  for (std::size_t v = 0; v < start.size(); ++v) {
    uphill.step.push_back((start[v] - plain[v]).cast<float>());
  }
  options.last = &uphill;
  EXPECT_EQ(polish_from(mesh, start, options).uvs, plain);
  ASSERT_EQ(uphill.step.size(), start.size());
  EXPECT_LE((uphill.step[50].cast<double>() - (plain[50] - start[50])).norm(), 1e-5);
}

TEST(Polish, HasTheSameBitsOnTwoThreads) {
  const DiskMesh mesh = disks::disk(meshes::bumps(70, 70));
  PolishOptions options;
  options.max_iterations = 5;
  EXPECT_EQ(polish_from(mesh, disks::flat_uvs(mesh), options, 1).uvs,
            polish_from(mesh, disks::flat_uvs(mesh), options, 2).uvs);
}

}  // namespace
}  // namespace beltrami
