// The reduced harmonic subspace: meta vertices, samples, rows of the basis, GIF and FLIM.
#include "baselines/reduced/reduced.h"
#include "base/interrupt.h"
#include "base/portable_math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/error.h"
#include "baselines/reduced/meta_vertices.h"
#include "baselines/reduced/reduced_basis.h"
#include "baselines/reduced/samples.h"
#include "exact/certificate.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "prolong/prolongation.h"
#include "repair/repair.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

struct Problem {
  DiskMesh mesh;
  std::vector<RestTriangle> rest;
  std::vector<FaceMetric> metric;
};

Problem problem_of(meshes::TriangleList list) {
  Problem problem;
  normalise(list.positions, list.faces, Work(1));
  problem.mesh = build_disk(std::move(list.positions), std::move(list.faces), Work(1));
  problem.rest = rest_triangles(problem.mesh.positions, problem.mesh.faces, Work(1));
  problem.metric.resize(problem.mesh.faces.size());
  return problem;
}

/// A smooth metric far from the identity, so that some cotangents are negative.
Problem with_smooth_metric(Problem problem) {
  for (Index f = 0; f < problem.mesh.face_count(); ++f) {
    const Vec3& p = problem.mesh.positions[problem.mesh.faces[f][0]];
    problem.metric[f].mu = 0.6 * std::polar(1.0, 3 * p.x() + 2 * p.y());
  }
  return problem;
}

std::vector<Cotangents> cotangents_of(const Problem& problem) {
  return modified_cotangents(problem.rest, problem.metric, Work(1));
}

ReducedResult flatten(const Problem& problem, const ReducedOptions& options = {}, int threads = 1) {
  return flatten_reduced(problem.mesh, problem.rest, cotangents_of(problem), options,
                         Work(threads));
}

/// n cells in a row, joined to a square by one edge, which is a bridge, and ears at the corners.
meshes::TriangleList grid_with_flag(Index n) {
  meshes::TriangleList list = meshes::grid(n, n);
  const Index a = n / 2, b = a + 1;  // an edge of the lower side
  const auto apex = static_cast<Index>(list.positions.size());
  list.positions.push_back({(a + 0.5) / n, -0.2, 0.1});
  list.faces.push_back({b, a, apex});
  return list;
}

/// A strip that coils up: its flattening on a circle must be unrolled without crossing itself.
meshes::TriangleList coil(Index turns_in_cells) {
  meshes::TriangleList list = meshes::grid(turns_in_cells, 3);
  for (Vec3& p : list.positions) {
    const double angle = 4 * std::numbers::pi * p.x(), radius = 1 + p.x();
    p = {radius * portable::cos(angle), radius * portable::sin(angle), 0.5 * p.y()};
  }
  return list;
}

void expect_never_rising(const std::vector<double>& energies) {
  ASSERT_FALSE(energies.empty());
  for (std::size_t i = 1; i < energies.size(); ++i) EXPECT_LE(energies[i], energies[i - 1]);
}

std::int64_t flips_after_repair(const Problem& problem, std::vector<Vec2> uvs) {
  repair(problem.mesh, problem.rest, uvs, {}, Work(1));
  const auto counted = count_orientations(problem.mesh.faces, uvs, Work(1));
  return counted.negative + counted.degenerate;
}

TEST(SolveRows, EqualTheRowsOfTheFullSolve) {
  const DiskMesh mesh = problem_of(meshes::bumps(40, 30)).mesh;
  MeshMatrix laplacian(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1, Work(1));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      laplacian.add(f, mesh.faces[f], k, k, [](int, int) { return 1.0; });
      laplacian.add(f, mesh.faces[f], k, next_corner(k), [](int, int) { return -0.5; });
    }
  }
  const Index n = laplacian.free_count(), columns = 37;  // not a multiple of any block
  SparseMatrix rhs(n, columns);
  for (Index c = 0; c < columns; ++c) {
    rhs.insert((7 * c) % n, c) = 1 + c;
    if (c % 5 != 0) rhs.insert((11 * c + 500) % n, c) = -0.25;
  }
  const std::vector<Index> rows = {3, n - 1, 0, 200, 3};
  const auto solver = make_spd_solver({}, Work(1));
  solver->analyze(laplacian.matrix());
  ASSERT_TRUE(solver->factorize(laplacian.matrix()));
  const DenseMatrix whole = solver->solve(DenseMatrix(rhs));
  const DenseMatrix some = solver->solve_rows(rhs, rows);
  ASSERT_EQ(some.rows(), size_of(rows));
  ASSERT_EQ(some.cols(), columns);
  for (Index i = 0; i < size_of(rows); ++i) {
    // The Eigen back end does the same operations in the same order, CHOLMOD blocks them otherwise.
    if (std::string(spd_solver_name()) == "eigen") {
      EXPECT_EQ(some.row(i), whole.row(rows[i]));
    } else {
      EXPECT_TRUE(some.row(i).isApprox(whole.row(rows[i]), 1e-13));
    }
  }
  EXPECT_EQ(solver->solve_rows(rhs, rows), some);
  EXPECT_EQ(solver->solve_rows(rhs, {}).rows(), 0);
}

TEST(MetaVertices, TakeEveryVertexOfAShortBoundary) {
  const Problem problem = problem_of(meshes::grid(10, 10));
  EXPECT_EQ(choose_meta_vertices(problem.mesh, Work(1)).count(), 40);
}

TEST(MetaVertices, AreFewOnALongBoundary) {
  const Problem problem = problem_of(meshes::grid(400, 400));
  const MetaVertices metas = choose_meta_vertices(problem.mesh, Work(1));
  EXPECT_GT(metas.count(), 70);
  EXPECT_LE(metas.count(), 260);
  EXPECT_TRUE(std::is_sorted(metas.loop.begin(), metas.loop.end()));
}

TEST(MetaVertices, TakeBridgeEndsAndAVertexBetween) {
  const Problem problem = problem_of(grid_with_flag(100));
  const MetaVertices metas = choose_meta_vertices(problem.mesh, Work(1));
  std::vector<bool> is_meta(problem.mesh.vertex_count(), false);
  for (const Index at : metas.loop) is_meta[problem.mesh.boundary[at]] = true;
  EXPECT_TRUE(is_meta[50]);
  EXPECT_TRUE(is_meta[51]);
  EXPECT_TRUE(is_meta[problem.mesh.vertex_count() - 1]) << "the tip of the ear";
}

TEST(MetaVertices, SpaceTheOthersByArcLength) {
  const Problem problem = problem_of(meshes::grid(60, 60));
  const MetaVertices metas = choose_meta_vertices(problem.mesh, Work(1));
  const Index count = size_of(problem.mesh.boundary);
  double length = 0;
  for (const double arc : metas.arc) {
    EXPECT_GT(arc, 0);
    length += arc;
  }
  EXPECT_NEAR(length, 4 * std::sqrt(surface_area(problem.mesh, Work(1))), 1e-9);
  for (Index i = 0; i < count; ++i) {
    EXPECT_GE(metas.share[i], 0);
    EXPECT_LT(metas.share[i], 1);
    EXPECT_EQ(metas.share[i] == 0, metas.loop[metas.piece[i]] == i);
  }
}

TEST(Samples, StandForTheWholeArea) {
  const Problem problem = problem_of(meshes::bumps(120, 90));
  const MetaVertices metas = choose_meta_vertices(problem.mesh, Work(1));
  const SampledFaces samples = sample_faces(problem.mesh, problem.rest, metas, 500);
  double sampled = 0, area = 0;
  for (const double w : samples.weights) {
    EXPECT_GT(w, 0);
    sampled += w;
  }
  for (const RestTriangle& r : problem.rest) area += r.area();
  EXPECT_NEAR(sampled, area, 1e-9 * area);
  EXPECT_GE(size_of(samples.faces), 500);
  EXPECT_LT(size_of(samples.faces), problem.mesh.face_count() / 4);
  std::vector<Index> faces = samples.faces;
  std::sort(faces.begin(), faces.end());
  EXPECT_EQ(std::unique(faces.begin(), faces.end()), faces.end()) << "a face is sampled twice";
}

TEST(Samples, AreAllFacesOfASmallMesh) {
  const Problem problem = problem_of(meshes::bumps(12, 9));
  const MetaVertices metas = choose_meta_vertices(problem.mesh, Work(1));
  EXPECT_EQ(size_of(sample_faces(problem.mesh, problem.rest, metas, 2000).faces),
            problem.mesh.face_count());
}

TEST(ReducedBasis, RowsExpandToTheWholeMap) {
  const Problem problem = with_smooth_metric(problem_of(meshes::bumps(30, 40)));
  const ReducedBasis basis(problem.mesh, cotangents_of(problem),
                           choose_meta_vertices(problem.mesh, Work(1)), Work(1));
  std::vector<Vec2> x;
  DenseMatrix places(basis.metas().count(), 2);
  for (Index m = 0; m < basis.metas().count(); ++m) {
    x.push_back({portable::sin(m), portable::cos(2 * m)});
    places.row(m) = x.back().transpose();
  }
  const std::vector<Vec2> uvs = basis.expand(x);
  const std::vector<Index> vertices = {0, 5, problem.mesh.vertex_count() / 2, 300, 301};
  const DenseMatrix rows = basis.rows(vertices);
  for (Index i = 0; i < size_of(vertices); ++i) {
    EXPECT_NEAR(rows.row(i).sum(), 1, 1e-10) << "not invariant to translations";
    EXPECT_LT((rows.row(i) * places - uvs[vertices[i]].transpose()).norm(), 1e-10);
  }
}

TEST(FlattenReduced, FindsThePlaneMapOfAPlaneMesh) {
  const Problem problem = problem_of(meshes::grid(24, 24));
  const ReducedResult result = flatten(problem);
  EXPECT_TRUE(result.converged);
  expect_never_rising(result.energies);
  EXPECT_LT(result.energies.back(), 2.02);
  EXPECT_TRUE(certify(problem.mesh.faces, problem.mesh.boundary, result.uvs, Work(1)).injective());
}

TEST(FlattenReduced, FlattensACap) {
  const Problem problem = problem_of(meshes::cap(20, 48, 1.2));
  for (const bool scaffold : {true, false}) {
    ReducedOptions options;
    options.scaffold = scaffold;
    const ReducedResult result = flatten(problem, options);
    EXPECT_TRUE(result.converged);
    expect_never_rising(result.energies);
    EXPECT_LT(result.energies.back(), 2.2);
    EXPECT_TRUE(
        certify(problem.mesh.faces, problem.mesh.boundary, result.uvs, Work(1)).injective());
  }
}

TEST(FlattenReduced, FlattensInAPrescribedMetric) {
  const Problem problem = with_smooth_metric(problem_of(meshes::bumps(50, 50)));
  const ReducedResult result = flatten(problem);
  expect_never_rising(result.energies);
  EXPECT_TRUE(result.simple_boundary);
  EXPECT_EQ(flips_after_repair(problem, result.uvs), 0);
}

TEST(FlattenReduced, KeepsBridgesAndEarsOpen) {
  const Problem problem = problem_of(grid_with_flag(30));
  const ReducedResult result = flatten(problem);
  EXPECT_TRUE(result.simple_boundary);
  EXPECT_EQ(flips_after_repair(problem, result.uvs), 0);
  EXPECT_LT(result.energies.back(), 2.1);
}

TEST(FlattenReduced, TakesMeshesWithoutInteriorVertices) {
  for (const auto& list : {meshes::triangle(), meshes::quad(), meshes::fan(3), meshes::fan(7),
                           meshes::strip(1), meshes::strip(20), meshes::grid(2, 2)}) {
    const Problem problem = problem_of(list);
    for (const bool scaffold : {true, false}) {
      ReducedOptions options;
      options.scaffold = scaffold;
      const ReducedResult result = flatten(problem, options);
      expect_never_rising(result.energies);
      EXPECT_LT(result.energies.back(), 2.01) << list.faces.size() << " faces";
      EXPECT_EQ(flips_after_repair(problem, result.uvs), 0) << list.faces.size() << " faces";
    }
  }
}

TEST(FlattenReduced, KeepsTheBoundarySimpleWhereItWouldCross) {
  const Problem problem = problem_of(coil(120));
  const ReducedResult result = flatten(problem);
  expect_never_rising(result.energies);
  EXPECT_TRUE(result.simple_boundary);
  EXPECT_EQ(flips_after_repair(problem, result.uvs), 0);
}

TEST(FlattenReduced, ToleratesFacesWithoutArea) {
  meshes::TriangleList list = meshes::bumps(20, 20);
  list.positions[0] = list.positions[1];      // a boundary edge of no length
  list.positions[100] = list.positions[101];  // faces of no area inside
  const Problem problem = problem_of(list);
  const ReducedResult result = flatten(problem);
  for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
  expect_never_rising(result.energies);
  EXPECT_EQ(flips_after_repair(problem, result.uvs), 0);
}

TEST(FlattenReduced, RefusesMoreBridgesThanDenseAlgebraServes) {
  const Problem problem = problem_of(meshes::strip(600));
  try {
    flatten(problem);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kSolver);
  }
}

TEST(FlattenReduced, GivesTheSameBitsAtOneAndTwoThreads) {
  const Problem problem = with_smooth_metric(problem_of(meshes::bumps(60, 50)));
  ReducedOptions options;
  options.max_iterations = 8;
  const ReducedResult one = flatten(problem, options, 1);
  const ReducedResult two = flatten(problem, options, 2);
  EXPECT_EQ(one.energies, two.energies);
  EXPECT_EQ(one.uvs, two.uvs);
}

TEST(FlattenReduced, CanBeCancelledAtEveryReport) {
  const Problem problem = problem_of(meshes::bumps(16, 16));
  int reports = 0;
  double last = 0;
  flatten_reduced(problem.mesh, problem.rest, cotangents_of(problem), {},
                  Work({}, [&](double fraction, const char*) {
                    ++reports;
                    EXPECT_GE(fraction, last);
                    EXPECT_LE(fraction, 1);
                    last = fraction;
                    return false;
                  }));
  EXPECT_GT(reports, 4);
  for (int stop = 1; stop <= reports; ++stop) {
    int seen = 0;
    EXPECT_THROW(flatten_reduced(problem.mesh, problem.rest, cotangents_of(problem), {},
                                 Work({}, [&](double, const char*) { return ++seen == stop; })),
                 Cancelled);
  }
}

}  // namespace
}  // namespace beltrami
