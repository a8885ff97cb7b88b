// Newton's method vertex by vertex: what it must never do, and what it is for.
#include "local/vertex_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/work.h"
#include "descend/tutte.h"
#include "energy/density.h"
#include "energy/energy.h"
#include "energy/exponential_dirichlet.h"
#include "energy/symmetric_dirichlet.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// A grid whose map is rough: all vertices inside are off their places.
struct Rough {
  Rough() {
    disks::Random random(5);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.on_boundary[v]) continue;
      uvs[v] += 0.2 * spacing * random.vec2();
    }
  }

  double mean(Energy energy) const { return mean_energy(energy, mesh.faces, rest, uvs, Work(1)); }
  void sweep(Energy energy = Energy::kSymmetricDirichlet) {
    std::vector<Index> all(mesh.vertex_count());
    std::iota(all.begin(), all.end(), 0);
    sweep_vertices(energy, mesh, rest, uvs, all);
  }
  bool positive() const { return non_positive_faces(mesh.faces, uvs, Work(1)).empty(); }

  static constexpr int kSide = 100;
  DiskMesh mesh = disks::disk(meshes::grid(kSide, kSide));
  std::vector<RestTriangle> rest = disks::rest_of(mesh);
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  double spacing = (uvs[mesh.faces[0][1]] - uvs[mesh.faces[0][0]]).norm();
};

TEST(VertexSweep, LowersAllEnergiesAndFlipsNothing) {
  for (const Energy energy : disks::kEnergies) {
    Rough map;
    ASSERT_TRUE(map.positive());
    const std::vector<Vec2> start = map.uvs;
    double before = map.mean(energy);
    for (int i = 0; i < 3; ++i) {
      map.sweep(energy);
      EXPECT_LT(map.mean(energy), before);
      EXPECT_TRUE(map.positive());
      before = map.mean(energy);
    }
    for (const Index v : map.mesh.boundary) EXPECT_EQ(map.uvs[v], start[v]);
  }
}

TEST(VertexSweep, TakesRoughnessOutAtOnce) {
  Rough map;
  const double isometric = SymmetricDirichlet::kMinimum;
  const double before = map.mean(Energy::kSymmetricDirichlet) - isometric;
  for (int i = 0; i < 2; ++i) map.sweep();
  EXPECT_LT(map.mean(Energy::kSymmetricDirichlet) - isometric, 0.1 * before);
}

TEST(VertexSweep, MovesOnlyTheVerticesGiven) {
  Rough map;
  const std::vector<Vec2> start = map.uvs;
  const Index inside = (Rough::kSide + 1) * (Rough::kSide / 2) + Rough::kSide / 2;
  sweep_vertices(Energy::kSymmetricDirichlet, map.mesh, map.rest, map.uvs, {inside, 0});
  for (Index v = 0; v < map.mesh.vertex_count(); ++v) {
    EXPECT_EQ(map.uvs[v] != start[v], v == inside);
  }
}

TEST(VertexSweep, LeavesAMinimumAndWhatIsFlippedAsTheyAre) {
  Rough map;
  map.uvs = disks::flat_uvs(map.mesh);
  const std::vector<Vec2> flat = map.uvs;
  map.sweep();
  EXPECT_EQ(map.uvs, flat);
  // A vertex beyond its neighbours: no face at it has an energy that could fall.
  const Index inside = (Rough::kSide + 1) * (Rough::kSide / 2) + Rough::kSide / 2;
  ASSERT_FALSE(map.mesh.on_boundary[inside]);
  map.uvs[inside] += Vec2(3 * map.spacing, 0);
  const Vec2 beyond = map.uvs[inside];
  const auto flipped = non_positive_faces(map.mesh.faces, map.uvs, Work(1));
  ASSERT_FALSE(flipped.empty());
  map.sweep();
  EXPECT_EQ(map.uvs[inside], beyond);
  EXPECT_EQ(non_positive_faces(map.mesh.faces, map.uvs, Work(1)), flipped);
}

/// Of a density by norm = s1^2 + s2^2 and det = s1 s2.
template <class Density>
double value_at(double norm, double det) {
  const double sum = std::sqrt(norm + 2 * det), difference = std::sqrt(norm - 2 * det);
  return Density::value(0.5 * (sum + difference), 0.5 * (sum - difference));
}

template <class Density>
void expect_bends_of_value() {
  for (const auto& [s1, s2] : {std::pair(1.5, 0.8), {2.0, 1.1}, {0.9, 0.4}, {1.1, 0.7}}) {
    const double norm = s1 * s1 + s2 * s2, det = s1 * s2, h = 1e-4;
    const auto at = [&](double n, double d) { return value_at<Density>(norm + n, det + d); };
    const DensityBends bends = Density::bends(norm, det);
    const double scale = std::abs(bends.norm_norm) + std::abs(bends.det_det);
    EXPECT_NEAR(bends.norm_norm, (at(h, 0) - 2 * at(0, 0) + at(-h, 0)) / (h * h), 1e-4 * scale);
    EXPECT_NEAR(bends.det_det, (at(0, h) - 2 * at(0, 0) + at(0, -h)) / (h * h), 1e-4 * scale);
    EXPECT_NEAR(bends.norm_det, (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4 * h * h),
                1e-4 * scale);
  }
}

TEST(DensityBends, AreTheSecondDerivativesOfTheValue) {
  expect_bends_of_value<SymmetricDirichlet>();
  expect_bends_of_value<ExponentialDirichlet>();
}

}  // namespace
}  // namespace beltrami
