// Large disks, in levels: as injective as any, nearly as low in energy as by the factor of the fine
// mesh, and the same whatever the threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "energy/energy.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"
#include "support/run.h"

namespace beltrami {
namespace {

using disks::run;
using meshes::TriangleList;

/// The least number of cells a side whose faces are flattened in levels.
constexpr Index kSide = 230;

TriangleList rough(Index side) {
  return meshes::height_field(side, side, [](double x, double y) {
    return 0.3 * portable::sin(7 * x) * portable::cos(5 * y + x) +
           0.004 * portable::sin(90 * x + 40 * y) * portable::cos(110 * y);
  });
}

/// With so many coarse faces that the levels are left out.
ChartOptions in_one_step(Index faces) {
  ChartOptions options;
  options.coarse_faces = faces / 7;
  return options;
}

double energy(const Flattening& result) {
  return result.distortion.symmetric_dirichlet;
}

TEST(Nested, IsForDisksOfSomeFacesThatAreFlattenedTheMetricWay) {
  EXPECT_TRUE(has_levels(1000000, 10000, {}));
  EXPECT_TRUE(has_levels(5000, 5000, {}));
  EXPECT_FALSE(has_levels(3000, 3000, {}));
  EXPECT_FALSE(has_levels(1000000, 1000, {})) << "another try than what was asked for";
  ChartOptions options;
  options.coarse_faces = 5000;
  EXPECT_FALSE(has_levels(50000, 5000, options)) << "a step serves";
  options.coarse_faces = 300000;
  EXPECT_FALSE(has_levels(1000000, 300000, options));
  options = {};
  options.flatten = Flatten::kDirichlet;
  EXPECT_FALSE(has_levels(1000000, 10000, options));
}

TEST(Nested, ComesCloseToTheMapOfOneStep) {
  const TriangleList mesh = rough(kSide);
  for (const Energy which : disks::kEnergies) {
    ChartOptions levels, step = in_one_step(size_of(mesh.faces));
    levels.energy = step.energy = which;
    const Flattening nested = run(mesh, levels), whole = run(mesh, step);
    EXPECT_EQ(nested.status, Outcome::kOk);
    EXPECT_TRUE(nested.certificate.injective());
    EXPECT_LE(energy(nested), 1.003 * energy(whole));
    EXPECT_LE(disks::distortion(which, mesh, nested),
              1.003 * disks::distortion(which, mesh, whole));
    EXPECT_EQ(nested.restarts, 0);
  }
}

TEST(Nested, KeepsABoundarySimpleThatWouldCrossItself) {
  const TriangleList mesh = disks::ramp(760, 72);
  const Flattening global = run(mesh);
  EXPECT_EQ(global.status, Outcome::kOk);
  EXPECT_TRUE(global.certificate.injective());
  EXPECT_EQ(global.restarts, 0);
  ChartOptions local;
  local.injectivity = Injectivity::kLocal;
  const Flattening overlapping = run(mesh, local);
  EXPECT_EQ(overlapping.certificate.orientations.negative, 0);
  EXPECT_GT(overlapping.certificate.crossings.count, 0);
  EXPECT_LT(energy(overlapping), energy(global));
}

TEST(Nested, HasTheSameBitsAtAnyNumberOfThreads) {
  const TriangleList mesh = rough(kSide);
  const Flattening one = run(mesh), two = run(mesh, {}, Work(2)), three = run(mesh, {}, Work(3));
  EXPECT_EQ(one.uvs, two.uvs);
  EXPECT_EQ(one.uvs, three.uvs);
}

TEST(Nested, ReportsProgressThatRisesAndCanBeCancelledOnTheWay) {
  const TriangleList mesh = rough(kSide);
  std::vector<double> fractions;
  run(mesh, {}, Work({}, [&](double fraction, const char*) {
        fractions.push_back(fraction);
        return false;
      }));
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  for (const double until : {0.1, 0.3, 0.6, 0.9}) {
    EXPECT_THROW(
        run(mesh, {}, Work({}, [&](double fraction, const char*) { return fraction >= until; })),
        Cancelled)
        << until;
  }
}

}  // namespace
}  // namespace beltrami
