// Disks at the ends of what floating point can hold: what is accepted is what is delivered.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/options.h"
#include "ring/ring_faces.h"
#include "ring/triangulate_ring.h"
#include "support/disks.h"
#include "support/hard_disks.h"
#include "support/run.h"
#include "support/shared_data.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

/// Runs, and judges the delivered numbers once more.
Flattening judged(TriangleList mesh, const ChartOptions& options) {
  Flattening result = disks::run(mesh, options);
  const DiskMesh disk = disks::disk(std::move(mesh));
  const auto& faces = result.faces.empty() ? disk.faces : result.faces;
  const Certificate again = certify(faces, disk.boundary, result.uvs, Work(1));
  EXPECT_EQ(again.injective(), result.certificate.injective());
  EXPECT_EQ(again.orientations.positive, result.certificate.orientations.positive);
  EXPECT_EQ(again.crossings.count, result.certificate.crossings.count);
  for (const Vec2& w : result.uvs) {
    EXPECT_TRUE(w.allFinite());
    if (!options.float32) continue;
    EXPECT_EQ(w, Vec2(w.cast<float>().cast<double>()));
  }
  return result;
}

ChartOptions method(Method which) {
  ChartOptions options;
  options.method = which;
  return options;
}

ChartOptions coarse(std::int64_t faces, bool float32) {
  ChartOptions options;
  options.coarse_faces = faces;
  options.float32 = float32;
  return options;
}

TEST(HardDisks, AreInjectiveAsDelivered) {
  for (const std::int64_t faces : {4, 8, 20}) {
    for (const bool float32 : {false, true}) {
      for (const bool square : {false, true}) {
        ChartOptions options = coarse(faces, float32);
        options.unit_square = square;
        const Flattening result = judged(disks::tree(), options);
        EXPECT_TRUE(result.certificate.injective()) << faces << float32 << square;
        EXPECT_LT(result.statistics.coarse_energy, 100) << faces << float32 << square;
      }
    }
  }
}

TEST(HardDisks, GetAMapWhereAlmostAllOfThemIsOnePoint) {
  for (const bool delaunay : {false, true}) {
    ChartOptions options = coarse(4, false);
    options.delaunay = delaunay;
    EXPECT_TRUE(judged(disks::collapsed(), options).certificate.injective()) << delaunay;
    options.float32 = true;
    EXPECT_EQ(judged(disks::collapsed(), options).status, Outcome::kNotInjectiveFloat32)
        << delaunay;
  }
}

TriangleList scaled(TriangleList mesh, double unit) {
  for (Vec3& p : mesh.positions) p *= unit;
  return mesh;
}

TEST(HardDisks, AreFlattenedInAnyUnitThatNumbersHold) {
  for (const double unit : {1e-310, 1e-307, 1e-160, 1e160, 1e300, 0x1p1021}) {
    const Flattening result = judged(scaled(meshes::grid(3, 3), unit), {});
    EXPECT_EQ(result.status, Outcome::kOk) << unit;
    EXPECT_TRUE(result.certificate.injective()) << unit;
    EXPECT_NEAR(result.distortion.symmetric_dirichlet, 2, 1e-3) << unit;
    ChartOptions square;
    square.unit_square = true;
    const Flattening fitted = judged(scaled(meshes::grid(3, 3), unit), square);
    EXPECT_TRUE(fitted.certificate.injective()) << unit;
    for (const Vec2& w : fitted.uvs) {
      EXPECT_TRUE(w.minCoeff() >= 0 && w.maxCoeff() <= 1) << unit;
    }
  }
}

TEST(HardDisks, AreSaidToBeOutOfTheRangeOfSinglePrecision) {
  for (const double unit : {1e-310, 1e-60, 1e60, 1e300}) {
    const Flattening single = judged(scaled(meshes::grid(3, 3), unit), coarse(0, true));
    EXPECT_EQ(single.status, Outcome::kNotInjectiveFloat32) << unit;
    EXPECT_EQ(single.restarts, 0) << unit << ": no other map would fit either";
    const Flattening both = judged(scaled(meshes::grid(3, 3), unit), {});
    EXPECT_TRUE(both.certificate.injective()) << unit;
    EXPECT_FALSE(both.single_certificate.injective()) << unit;
  }
}

TEST(HardDisks, AreSaidToUnfoldBeyondTheRangeOfNumbers) {
  // An accordion whose box holds the greatest numbers: laid flat it is longer than these.
  TriangleList mesh = meshes::grid(40, 1);
  for (Vec3& p : mesh.positions) {
    const auto column = static_cast<int>(std::lround(40 * p.x()));
    p = {0x1p1023 * p.x(), 0x1p1023 * p.y(), column % 2 == 0 ? 0x1.8p1023 : 0};
  }
  const Flattening result = judged(mesh, {});
  EXPECT_EQ(result.status, Outcome::kNotInjective);
}

TEST(HardDisks, AreFlattenedConformallyWhereTheyAreAlmostALine) {
  // Brought to unit area it would be longer than 1e80.
  TriangleList mesh = meshes::fan(9);
  for (Vec3& p : mesh.positions) p.setZero();
  mesh.positions[0] = {0, 0, 4e116};
  mesh.positions[1] = {2e83, 3e247, 0};
  mesh.positions[2] = {1e251, 0, 0};
  mesh.positions[3] = {7e277, 0, 0};
  const Flattening result = judged(mesh, method(Method::kBff));
  EXPECT_GE(result.status, Outcome::kOk);
  EXPECT_EQ(result.restarts, 0);
}

TEST(HardDisks, WithoutInnerVerticesHaveAReducedMapOfSparseSteps) {
  // With more bridges than dense steps can serve.
  const Flattening strip = judged(meshes::strip(1500), method(Method::kGif));
  EXPECT_EQ(strip.status, Outcome::kOk);
  EXPECT_NEAR(strip.distortion.symmetric_dirichlet, 2, 0.01);
}

TEST(HardDisks, HaveACircleWhereTheyHaveNoArea) {
  TriangleList mesh = meshes::grid(3, 3);
  for (Vec3& p : mesh.positions) p.setZero();
  const DiskMesh disk = disks::disk(mesh);
  EXPECT_TRUE(
      certify(disk.faces, disk.boundary, tutte_embedding(disk, Work(1)), Work(1)).injective());
}

TEST(HardDisks, EndWhereNoSystemIsDefinite) {
  // Of a map that shrinks by 1e-80 the energy is a number, its fourth powers are not.
  const DiskMesh disk = disks::disk(meshes::grid(2, 2));
  const std::vector<Vec2> before = disks::flat_uvs(disk);
  std::vector<Vec2> after = before;
  const std::vector<RestTriangle> rest(disk.faces.size(), {1e80, 0, 1e80});
  NewtonOptions options;
  options.proxy_steps = 0;
  const NewtonResult done =
      minimise_energy(disk.faces, rest, disks::only_fixed(disk, 0), after, options, Work(1));
  EXPECT_FALSE(done.converged);
  EXPECT_EQ(after, before);
}

TEST(HardDisks, HaveARingAroundABoundaryThatIsSmallAndFarAway) {
  const double ulp = 0x1p-52;
  const std::vector<Vec2> polygon = {{1, 1}, {1 + ulp, 1}, {1, 1 + ulp}};
  EXPECT_EQ(triangulate_ring(polygon, scaffold_circle(polygon)).faces.size(), 51u);
}

struct SharedDisk {
  const char* name;
  ChartOptions options;
};

TEST(HardDisks, OfTheSharedDataEndWithAMap) {
  const std::filesystem::path folder = shared_data::folder() / "broken";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the mesh data are not here";
  const std::vector<SharedDisk> all = {
      {"not_injective_coarse/tree_580.obj", coarse(20, false)},
      {"not_injective_coarse/tube_1300.obj", coarse(4, true)},
      {"not_injective_coarse/treerand_1446.obj", coarse(4, true)},
      {"scaffold_internal/in.obj", coarse(4, false)},
      {"scaffold_internal/in.obj", coarse(8, false)},
      {"denormal_coordinates/grid.obj", {}},
      {"gif_thin_strip_slow/in.obj", method(Method::kGif)},
  };
  for (const auto& [name, options] : all) {
    const Flattening result = judged(shared_data::read_obj(folder / name), options);
    EXPECT_TRUE(result.certificate.injective()) << name;
    EXPECT_TRUE(std::isfinite(result.distortion.symmetric_dirichlet)) << name;
  }
  const auto bff =
      judged(shared_data::read_obj(folder / "bff_exit4" / "in.obj"), method(Method::kBff));
  EXPECT_TRUE(std::isfinite(bff.distortion.symmetric_dirichlet));
}

}  // namespace
}  // namespace beltrami
