// What a seam costs, term by term.
#include "cut/seam_costs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "cut/surface_sketch.h"
#include "mesh/surface.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Surface surface_of(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

/// Of one vertex more than a small surface has.
TriangleList large_torus() {
  return meshes::torus(150);
}

std::vector<double> costs_of(const Surface& surface, int threads = 1) {
  return seam_costs(surface, {}, {}, Work(threads));
}

std::vector<double> concavity_of(const Surface& surface) {
  return edge_concavity(surface, sketch(surface, Work(1)), Work(1));
}

Vec3 middle_of(const Surface& surface, Index h) {
  return (surface.positions[surface.origin(h)] + surface.positions[surface.target(h)]) / 2;
}

TEST(SeamCosts, ArePositiveFiniteAndAlikeForBothHalfEdges) {
  TriangleList folded = meshes::grid(6, 6);  // faces without area, edges without length
  for (Index v = 0; v < 20; ++v) folded.positions[v] = {0.5, 0.5, 0};
  const TriangleList collapsed =
      meshes::moved(meshes::torus(5), [](const Vec3&) { return Vec3(1, 2, 3); });
  const TriangleList line =
      meshes::moved(meshes::torus(150), [](const Vec3& p) { return Vec3(p.x(), 0, 0); });
  for (const TriangleList& mesh :
       {meshes::triangle(), meshes::tetrahedron(), meshes::cube(), meshes::bumps(9, 7),
        meshes::torus(12), meshes::two_components(), large_torus(), folded, collapsed, line,
        meshes::with_unused_in_front(meshes::quad(), 3)}) {
    const Surface surface = surface_of(mesh);
    const std::vector<double> costs = costs_of(surface);
    ASSERT_EQ(costs.size(), surface.twin.size());
    for (Index h = 0; h < size_of(costs); ++h) {
      ASSERT_TRUE(std::isfinite(costs[h]) && costs[h] > 0);
      ASSERT_TRUE(surface.twin[h] == kNone || costs[h] == costs[surface.twin[h]]);
    }
  }
}

TEST(SeamCosts, AreLengthsWhereNothingElseCounts) {
  const Surface surface = surface_of(meshes::bumps(9, 7));
  EXPECT_EQ(seam_costs(surface, {0, 0, 1, 1}, {}, Work(1)), edge_lengths(surface, Work(1)));
}

TEST(SeamCosts, ScaleWithTheSurface) {
  for (const TriangleList& mesh : {meshes::bumps(20, 20), large_torus()}) {
    const std::vector<double> costs = costs_of(surface_of(mesh));
    const std::vector<double> times_four =
        costs_of(surface_of(meshes::moved(mesh, [](const Vec3& p) { return Vec3(4 * p); })));
    for (std::size_t h = 0; h < costs.size(); ++h) ASSERT_EQ(4 * costs[h], times_four[h]);
  }
}

TEST(SeamCosts, AreTheSameBitsAtTwoThreads) {
  for (const TriangleList& mesh : {meshes::bumps(60, 60), large_torus()}) {
    const Surface surface = surface_of(mesh);
    EXPECT_EQ(costs_of(surface, 1), costs_of(surface, 2));
  }
}

TEST(SeamCosts, DoNotDependOnTheOrderOfFacesAndVertices) {
  for (const TriangleList& mesh : {meshes::bumps(20, 20), large_torus()}) {
    const std::vector<Index> vertices = meshes::shuffled(size_of(mesh.positions), 1);
    const std::vector<Index> faces = meshes::shuffled(size_of(mesh.faces), 2);
    TriangleList other = mesh;
    for (Index v = 0; v < size_of(vertices); ++v) other.positions[vertices[v]] = mesh.positions[v];
    for (Index f = 0; f < size_of(faces); ++f) {
      for (int k = 0; k < 3; ++k) other.faces[faces[f]][k] = vertices[mesh.faces[f][k]];
    }
    const std::vector<double> costs = costs_of(surface_of(mesh));
    const std::vector<double> shuffled = costs_of(surface_of(other));
    // A depth that decides by its last bit may fall the other way: a direction of 64 at a place.
    int apart = 0;
    for (Index f = 0; f < size_of(faces); ++f) {
      for (int k = 0; k < 3; ++k) {
        const double difference = std::abs(costs[3 * f + k] / shuffled[3 * faces[f] + k] - 1);
        ASSERT_LT(difference, 0.02);
        apart += difference > 1e-9 ? 1 : 0;
      }
    }
    EXPECT_LE(apart, size_of(faces) / 100);
  }
}

TEST(SeamCosts, NearlyStayInATurnedSurface) {
  const Eigen::Matrix3d turn = meshes::some_turn();
  for (const TriangleList& mesh : {meshes::torus(40), large_torus()}) {
    const std::vector<double> costs = costs_of(surface_of(mesh));
    const std::vector<double> turned =
        costs_of(surface_of(meshes::moved(mesh, [&](const Vec3& p) { return Vec3(turn * p); })));
    double sum = 0;
    for (std::size_t h = 0; h < costs.size(); ++h) {
      ASSERT_NEAR(turned[h] / costs[h], 1, 0.15);
      sum += std::abs(turned[h] / costs[h] - 1);
    }
    EXPECT_LT(sum / static_cast<double>(costs.size()), 0.02);
  }
}

/// A sheet folded along its middle by right angles: up, or down as a valley.
TriangleList fold(Index n, double slope) {
  return meshes::height_field(n, n, [&](double x, double) { return slope * std::abs(x - 0.5); });
}

TEST(SeamCosts, ConcaveIsAValleyAndConvexARidge) {
  // Coarse, where edges are their own neighbourhood; fine; and clusters.
  for (const Index n : {4, 60, 160}) {
    for (const double slope : {1.0, -1.0}) {
      const Surface surface = surface_of(fold(n, slope));
      const SurfaceSketch flat = sketch(surface, Work(1));
      const bool is_inside_out = flat.inside_out[0];
      const std::vector<double> concavity = concavity_of(surface);
      for (Index h = 0; h < size_of(concavity); ++h) {
        const Vec3 middle = middle_of(surface, h);
        ASSERT_LE(std::abs(concavity[h]), 1);
        const double c = (is_inside_out ? -slope : slope) * concavity[h];
        const Vec3 along =
            surface.positions[surface.target(h)] - surface.positions[surface.origin(h)];
        if (std::abs(middle.x() - 0.5) < 1e-9 && along.x() == 0) {
          ASSERT_GT(c, 0.5);
        } else if (std::abs(middle.x() - 0.5) > 0.3) {
          ASSERT_NEAR(c, 0, 1e-9);
        }
      }
    }
  }
}

TEST(SeamCosts, ConcavityLooksFromOutsideWhicheverWayFacesTurn) {
  TriangleList mesh = meshes::torus(20);
  const std::vector<double> concavity = concavity_of(surface_of(mesh));
  EXPECT_LT(*std::min_element(concavity.begin(), concavity.end()), 0);
  for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
  const std::vector<double> turned = concavity_of(surface_of(mesh));
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(concavity[3 * f + k], turned[3 * f + (2 - k)], 1e-12);
    }
  }
}

TEST(SeamCosts, NoiseDoesNotDecideWhatIsConcave) {
  // Bends of the noise are ten times those of the sphere.
  const TriangleList sphere = meshes::sphere(6);
  const Surface smooth = surface_of(sphere);
  const Surface noisy = surface_of(meshes::shaken(sphere, 0.005, 7));
  const std::vector<double> without = concavity_of(smooth), with = concavity_of(noisy);
  double difference = 0;
  Index wrong = 0;
  for (std::size_t h = 0; h < with.size(); ++h) {
    ASSERT_LT(without[h], 0);
    difference += std::abs(with[h] - without[h]);
    wrong += with[h] > 0 ? 1 : 0;
  }
  EXPECT_LT(difference / static_cast<double>(with.size()), 0.05);
  EXPECT_LT(wrong, 0.2 * static_cast<double>(with.size()));
}

TEST(SeamCosts, HardEdgesAreThoseOfACube) {
  const Surface surface = surface_of(meshes::split_in_four(meshes::cube(), 3));
  std::vector<double> factors(surface.twin.size(), 1);
  weigh_hard_edges(surface, sketch(surface, Work(1)), std::numbers::pi / 3, 0.5, factors, Work(1));
  const auto on_edge = [](const Vec3& p) {
    int whole = 0;
    for (const double x : p) whole += x == 0 || x == 1 ? 1 : 0;
    return whole >= 2;
  };
  for (Index h = 0; h < size_of(factors); ++h) {
    EXPECT_EQ(factors[h], on_edge(middle_of(surface, h)) ? 0.5 : 1);
  }
  weigh_hard_edges(surface, sketch(surface, Work(1)), std::numbers::pi, 0.5, factors, Work(1));
  EXPECT_EQ(*std::min_element(factors.begin(), factors.end()), 0.5);
}

TEST(SeamCosts, LabelsCountWhereTheyDiffer) {
  const Surface surface = surface_of(meshes::grid(4, 4));
  std::vector<Index> labels(surface.faces.size(), 3);
  labels[7] = 8;
  std::vector<double> factors(surface.twin.size(), 1);
  weigh_labels(surface, labels, 0.25, factors, Work(1));
  for (Index h = 0; h < size_of(factors); ++h) {
    const Index twin = surface.twin[h];
    const bool differs = twin != kNone && (h / 3 == 7) != (twin / 3 == 7);
    EXPECT_EQ(factors[h], differs ? 0.25 : 1);
  }
}

TEST(SeamCosts, PaintIsOfVerticesAndEdgesWithinItsRange) {
  const Surface surface = surface_of(meshes::quad());  // 0 1 2, 0 2 3
  const auto painted = [&](const std::vector<double>& vertices,
                           const std::vector<PaintedEdge>& edges) {
    std::vector<double> factors(surface.twin.size(), 1);
    weigh_paint(surface, vertices, edges, factors, Work(1));
    return factors;
  };
  EXPECT_EQ(painted({}, {}), std::vector<double>(6, 1));
  EXPECT_EQ(painted({1, 1, 1, 1}, {}), std::vector<double>(6, 1));
  // Half-edges 0 1, 1 2, 2 0, 0 2, 2 3, 3 0.
  const std::vector<double> corner = painted({4, 1, 4, 1}, {});
  EXPECT_EQ(corner, (std::vector<double>{2, 2, 4, 4, 2, 2}));
  EXPECT_EQ(painted({0, 0, 0, 0}, {}), painted({0.05, 0.05, 0.05, 0.05}, {}));
  EXPECT_EQ(painted({}, {{{2, 0}, 1e30}, {{3, 0}, 0}, {{1, 3}, 7}}),
            (std::vector<double>{1, 1, kMostPaint, kMostPaint, 1, kLeastPaint}));
}

TEST(SeamCosts, HintsReachTheCosts) {
  const Surface surface = surface_of(meshes::split_in_four(meshes::cube(), 2));
  const std::vector<double> plain = costs_of(surface);
  SeamHints hints;
  hints.vertex_paint.assign(surface.positions.size(), 2);
  hints.edge_paint = {{{surface.target(0), surface.origin(0)}, 3}};
  hints.labels.assign(surface.faces.size(), 0);
  hints.labels[9] = 1;
  const SeamWeights weights;
  const std::vector<double> costs = seam_costs(surface, weights, hints, Work(1));
  for (Index h = 0; h < size_of(costs); ++h) {
    double factor = 2;
    if (surface.edge(h) == surface.edge(0)) factor *= 3;
    if ((h / 3 == 9) != (surface.twin[h] / 3 == 9)) factor *= weights.materials;
    EXPECT_NEAR(costs[h] / plain[h], factor, 1e-12);
  }
}

}  // namespace
}  // namespace beltrami
