// Whole runs on disks that cover themselves at their free minimum, and on strips of no height.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "descend/flat_start.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"
#include "support/run.h"
#include "support/shared_data.h"

namespace beltrami {
namespace {

using disks::run;
using meshes::TriangleList;

ChartOptions local() {
  ChartOptions options;
  options.injectivity = Injectivity::kLocal;
  return options;
}

double energy(const Flattening& result) {
  return result.distortion.symmetric_dirichlet;
}

struct NamedMesh {
  std::string name;
  TriangleList mesh;
};

TriangleList opened_blob(int levels, int points) {
  const TriangleList blob = disks::blob(levels);
  return disks::opened(blob, disks::seams_through(blob, points));
}

/// Coarse ones, and fine ones that are simplified first.
std::vector<NamedMesh> overlapping_meshes() {
  std::vector<NamedMesh> meshes = {{"slit saddle", disks::slit_saddle(10, 0.25)},
                                   {"blob of 24 points", opened_blob(4, 24)},
                                   {"blob of 60 points", opened_blob(4, 60)}};
  const TriangleList saddle = disks::refined(meshes.front().mesh, 3);
  const TriangleList blob = disks::refined(meshes.back().mesh, 2);
  meshes.push_back({"fine slit saddle", saddle});
  meshes.push_back({"fine blob of 60 points", blob});
  // Its seams zigzag, where those of the coarse mesh are straight.
  meshes.push_back({"fine blob opened along fine edges", opened_blob(5, 40)});
  return meshes;
}

TEST(Overlap, CostsLittleToAvoid) {
  for (const auto& [name, mesh] : overlapping_meshes()) {
    for (const Energy which : disks::kEnergies) {
      ChartOptions options, free = local();
      options.energy = free.energy = which;
      const Flattening covering = run(mesh, free), result = run(mesh, options);
      ASSERT_GT(covering.certificate.crossings.count, 0) << name;
      EXPECT_TRUE(result.certificate.injective()) << name;
      EXPECT_EQ(result.status, Outcome::kOk) << name;
      EXPECT_EQ(result.restarts, 0) << name;
      EXPECT_LE(disks::distortion(which, mesh, result),
                1.03 * disks::distortion(which, mesh, covering))
          << name << ", energy " << static_cast<int>(which);
    }
  }
}

TEST(Overlap, CostsLittleToAvoidWhereSidesOnlyJustTouch) {
  for (const double height : {0.0, 1e-8, 1e-4, 1e-2, 0.05, 1.0}) {
    for (const Index n : {5, 12}) {
      const std::string where = std::to_string(n) + " cells, height " + std::to_string(height);
      const TriangleList mesh = disks::slit_saddle(n, height);
      const double least = energy(run(mesh, local()));
      for (const std::int64_t coarse : {0, 60}) {
        ChartOptions options;
        options.coarse_faces = coarse;
        const Flattening result = run(mesh, options);
        EXPECT_TRUE(result.certificate.injective()) << where;
        EXPECT_EQ(result.status, Outcome::kOk) << where;
        EXPECT_LE(energy(result), 1.1 * least) << where << ", coarse " << coarse << " " << least;
      }
    }
  }
}

TEST(Overlap, IsNotLookedForWhereTheFreeMinimumHasNone) {
  for (const TriangleList& mesh : {meshes::bumps(20, 20), meshes::cap(10, 30, 2.0),
                                   opened_blob(4, 6), disks::refined(opened_blob(4, 6), 2)}) {
    const Flattening free = run(mesh, local());
    ASSERT_EQ(free.certificate.crossings.count, 0);
    EXPECT_EQ(run(mesh).uvs, free.uvs);
  }
}

TEST(Overlap, IsAvoidedWithTheSameBitsOnTwoAndThreeThreads) {
  for (const auto& [name, mesh] : overlapping_meshes()) {
    ChartOptions options;
    const Flattening one = run(mesh, options);
    for (const int threads : {2, 3}) {
      EXPECT_EQ(run(mesh, options, Work(threads)).uvs, one.uvs) << name << ", threads " << threads;
    }
  }
}

TEST(Overlap, IsAvoidedWithTheSameBitsInAnyUnitThatIsAPowerOfTwo) {
  for (const auto& [name, mesh] : overlapping_meshes()) {
    const Flattening plain = run(mesh);
    for (const int exponent : {-21, 20}) {
      const double unit = std::ldexp(1.0, exponent);
      TriangleList scaled = mesh;
      for (Vec3& p : scaled.positions) p *= unit;
      const Flattening result = run(scaled);
      std::size_t other = 0;
      for (std::size_t v = 0; v < plain.uvs.size(); ++v) {
        other += result.uvs[v] != Vec2(unit * plain.uvs[v]);
      }
      EXPECT_EQ(other, 0u) << name << ", unit 2^" << exponent;
    }
  }
}

TEST(Overlap, EndsNoHigherWithRefinement) {
  for (const auto& [name, mesh] : overlapping_meshes()) {
    for (const Energy which : disks::kEnergies) {
      ChartOptions options;
      options.energy = which;
      const double start = disks::distortion(which, mesh, run(mesh, options));
      options.refine = true;
      const Flattening refined = run(mesh, options);
      EXPECT_TRUE(refined.certificate.injective()) << name;
      EXPECT_EQ(refined.status, Outcome::kOk) << name;
      EXPECT_LE(disks::distortion(which, mesh, refined), start * (1 + 1e-12))
          << name << ", energy " << static_cast<int>(which);
    }
  }
}

TEST(Overlap, IsStationaryWhereRefinementSaysOk) {
  // Going on from there with a hundredth of the tolerance finds next to nothing.
  for (const auto& [name, mesh] : overlapping_meshes()) {
    ChartOptions options;
    options.refine = true;
    const Flattening refined = run(mesh, options);
    options.tolerance = 1e-6;
    const Flattening further = run(mesh, options);
    EXPECT_EQ(refined.status, Outcome::kOk) << name;
    EXPECT_LE(energy(refined), 1.001 * energy(further)) << name;
  }
}

TEST(Overlap, SaysSoWhereRefinementDidNotGetThere) {
  ChartOptions options;
  options.refine = true;
  options.max_iterations = 2;
  const Flattening result = run(opened_blob(4, 60), options);
  EXPECT_EQ(result.status, Outcome::kNotConverged);
  EXPECT_TRUE(result.certificate.injective());
}

/// Opens a closed surface along more and more seams: what each adds is a freedom.
void expect_no_rise(const TriangleList& closed, const std::vector<int>& points,
                    const std::string& name) {
  double before = std::numeric_limits<double>::infinity();
  for (const int count : points) {
    const TriangleList mesh = disks::opened(closed, disks::seams_through(closed, count));
    const std::string where = name + ", " + std::to_string(count) + " points";
    const Flattening result = run(mesh);
    EXPECT_TRUE(result.certificate.injective()) << where;
    EXPECT_LE(energy(result), 1.005 * before) << where;
    EXPECT_LE(energy(result), 1.03 * energy(run(mesh, local()))) << where;
    before = energy(result);
  }
}

TEST(Overlap, DoesNotMakeMoreSeamsRaiseTheEnergy) {
  expect_no_rise(disks::blob(4), {3, 6, 12, 24, 48, 96}, "blob");
  expect_no_rise(disks::blob(5), {6, 24, 96}, "fine blob");
}

TEST(Overlap, DoesNotMakeMoreSeamsOfScannedModelsRaiseTheEnergy) {
  const auto folder = shared_data::folder() / "closed";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the mesh data are not here";
  for (const std::string name : {"octopus_mainComp_f6000", "bunny"}) {
    expect_no_rise(shared_data::read_obj(folder / (name + ".obj")), {5, 10, 20, 40}, name);
  }
}

// ---- Strips and flat starts -----------------------------------------------------------------

/// A flat strip of length 1 in space.
TriangleList thin_strip(Index along, Index across, double height) {
  TriangleList mesh = meshes::grid(along, across);
  const Eigen::AngleAxisd turn(1.1, Vec3(1, -2, 0.5).normalized());
  for (Vec3& p : mesh.positions) p = turn * Vec3(p.x(), height * p.y(), 0);
  return mesh;
}

/// The same wound around a cylinder as a helix: still developable.
TriangleList wound_strip(Index along, Index across, double height) {
  constexpr double kTurns = 3, kRadius = 0.05;
  TriangleList mesh = meshes::grid(along, across);
  for (Vec3& p : mesh.positions) {
    const double angle = 2 * std::numbers::pi * kTurns * p.x();
    p = {kRadius * std::cos(angle), kRadius * std::sin(angle), 0.2 * p.x() + height * p.y()};
  }
  return mesh;
}

TEST(ThinStrip, IsFlattenedIsometrically) {
  const std::pair<Index, Index> sizes[] = {{100, 1}, {50, 2}, {355, 1}, {71, 5}};
  for (const auto& [along, across] : sizes) {
    for (const double height : {1e-4, 1e-6, 1e-8}) {
      for (const bool wound : {false, true}) {
        const std::string where = std::to_string(2 * along * across) + " faces, height " +
                                  std::to_string(height) + (wound ? ", wound" : ", flat");
        const Flattening result = run((wound ? wound_strip : thin_strip)(along, across, height));
        EXPECT_EQ(result.status, Outcome::kOk) << where;
        EXPECT_NEAR(energy(result), 2, 1e-6) << where;
        EXPECT_TRUE(result.certificate.injective()) << where;
      }
    }
  }
}

double worst_stretch(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  double worst = 0;
  for (const Triangle& t : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[next_corner(k)];
      const double length = (mesh.positions[b] - mesh.positions[a]).norm();
      worst = std::max(worst, std::abs((uvs[b] - uvs[a]).norm() / length - 1));
    }
  }
  return worst;
}

TEST(FlatStart, IsAnIsometryOfWhatIsFlat) {
  for (const TriangleList& list :
       {meshes::triangle(), meshes::quad(), meshes::grid(8, 6), meshes::fan(7),
        thin_strip(100, 1, 1e-4), thin_strip(50, 2, 1e-4)}) {
    const DiskMesh mesh = disks::disk(list);
    for (const auto& uvs : {projection(mesh), unfolding(mesh, disks::rest_of(mesh))}) {
      EXPECT_LE(worst_stretch(mesh, uvs), 1e-9) << mesh.face_count();
      EXPECT_TRUE(non_positive_faces(mesh.faces, uvs, Work(1)).empty()) << mesh.face_count();
    }
  }
}

TEST(FlatStart, UnfoldsWhatHasNoInnerVertex) {
  for (const TriangleList& list :
       {meshes::strip(50), wound_strip(100, 1, 1e-2), disks::winding(100, 1, 0.1, 1.3)}) {
    const DiskMesh mesh = disks::disk(list);
    const auto uvs = unfolding(mesh, disks::rest_of(mesh));
    EXPECT_LE(worst_stretch(mesh, uvs), 1e-9) << mesh.face_count();
    EXPECT_TRUE(non_positive_faces(mesh.faces, uvs, Work(1)).empty()) << mesh.face_count();
  }
}

TEST(FlatStart, IsNotTakenWhereSidesAreARoundingErrorApart) {
  // Laid out without distortion, the sides of the slit coincide, or not, as it happens.
  for (const Index n : {5, 12, 20}) {
    const Flattening result = run(disks::slit(n));
    EXPECT_TRUE(result.certificate.injective()) << n;
    EXPECT_EQ(result.status, Outcome::kOk) << n;
    EXPECT_NEAR(energy(result), 2, 2e-3) << n;
  }
}

TEST(FlatStart, IsNotTakenWhereItCoversItself) {
  // Isometric from face to face, but over itself.
  const TriangleList mesh = disks::winding(100, 1, 0.1, 1.3);
  const DiskMesh disk = disks::disk(mesh);
  const auto flat = unfolding(disk, disks::rest_of(disk));
  ASSERT_GT(count_crossings(disk.boundary, flat).count, 0);
  const Flattening result = run(mesh);
  EXPECT_TRUE(result.certificate.injective());
  EXPECT_GT(energy(result), 2 + 1e-5);
  EXPECT_LT(energy(result), 2.01);
}

}  // namespace
}  // namespace beltrami
