// Maps of disks of which something is known: as good as those made from the start.
#include "multilevel/inherited.h"
#include "chart/flattening.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/work.h"
#include "chart/flatten_disk.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

struct Disk {
  DiskMesh mesh;
  Normalisation frame;

  explicit Disk(meshes::TriangleList list) {
    frame = normalise(list.positions, list.faces, Work(1));
    mesh = disks::disk(std::move(list));
  }
  Flattening run(const Inherited& inherited, std::int64_t coarse_faces = 0) const {
    ChartOptions options;
    options.coarse_faces = coarse_faces;
    return flatten(mesh, frame, inherited, options, Work(1));
  }
  /// A map in the numbers that a start has.
  std::vector<Vec2> start(std::vector<Vec2> uvs) const {
    for (Vec2& w : uvs) w *= std::ldexp(1.0, frame.exponent);
    return uvs;
  }
};

double energy(const Flattening& result) {
  return result.distortion.symmetric_dirichlet;
}

TEST(Inherited, ALevelGivesTheSameEnergy) {
  const Disk disk(meshes::bumps(60, 60));
  Inherited inherited;
  inherited.level = simplify(disk.mesh, 3000, Work(1));
  const Flattening without = disk.run({}, 500), with = disk.run(inherited, 500);
  EXPECT_EQ(with.status, Outcome::kOk);
  EXPECT_TRUE(with.certificate.injective());
  EXPECT_EQ(with.restarts, 0);
  EXPECT_NEAR(energy(with), energy(without), 0.002 * energy(without));
}

TEST(Inherited, ALevelThatIsTooCoarseIsPassedOver) {
  const Disk disk(meshes::bumps(40, 40));
  Inherited inherited;
  inherited.level = simplify(disk.mesh, 500, Work(1));
  EXPECT_EQ(disk.run(inherited, 1000).uvs, disk.run({}, 1000).uvs);
}

TEST(Inherited, AStartNearTheMinimumSavesSteps) {
  const Disk disk(meshes::bumps(30, 30));
  const Flattening without = disk.run({});
  const Flattening with = disk.run({.start = disk.start(without.uvs)});
  EXPECT_EQ(with.status, Outcome::kOk);
  EXPECT_TRUE(with.certificate.injective());
  EXPECT_LE(energy(with), energy(without) * (1 + 1e-6));
  ASSERT_FALSE(with.statistics.stages.empty());
  EXPECT_LT(with.statistics.stages[0].iterations, without.statistics.stages[0].iterations);
}

TEST(Inherited, AFoldedStartIsPassedOver) {
  const Disk disk(meshes::bumps(12, 12));
  const Flattening without = disk.run({});
  std::vector<Vec2> folded = disk.start(without.uvs);
  for (Vec2& w : folded) w.x() = -w.x();
  EXPECT_EQ(disk.run({.start = folded}).uvs, without.uvs);
}

}  // namespace
}  // namespace beltrami
