// Whole runs with the exponential symmetric Dirichlet energy: what holds of every energy holds of
// it, and the worst faces are less distorted than with symmetric Dirichlet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "energy/energy.h"
#include "energy/measure.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"
#include "support/run.h"
#include "support/shared_data.h"

namespace beltrami {
namespace {

using disks::run;
using meshes::TriangleList;

ChartOptions exponential(std::int64_t coarse_faces = 0) {
  ChartOptions options;
  options.energy = Energy::kExponentialDirichlet;
  options.coarse_faces = coarse_faces;
  return options;
}

double distortion(const TriangleList& mesh, const Flattening& result) {
  return disks::distortion(Energy::kExponentialDirichlet, mesh, result);
}

/// The symmetric Dirichlet energy that this share of the faces exceeds.
double exceeded_by(double share, const Flattening& result) {
  std::vector<double> energies = result.face_energies;
  const auto nth =
      energies.begin() + static_cast<std::ptrdiff_t>((1 - share) * (energies.size() - 1.0));
  std::nth_element(energies.begin(), nth, energies.end());
  return *nth;
}

TEST(Exponential, FlattensAFlatMeshIsometrically) {
  const TriangleList mesh = meshes::grid(12, 9);
  EXPECT_NEAR(distortion(mesh, run(mesh, exponential())), 2, 1e-6);
  EXPECT_NEAR(distortion(mesh, run(mesh, exponential(60))), 2, 1e-4);
}

TEST(Exponential, HasTheSameBitsOnTwoThreads) {
  const TriangleList mesh = meshes::bumps(75, 75);
  for (const Flatten how : {Flatten::kMetric, Flatten::kGif}) {
    ChartOptions options = exponential(2000);
    options.flatten = how;
    const Flattening one = run(mesh, options), two = run(mesh, options, Work(2));
    EXPECT_EQ(one.uvs, two.uvs);
    EXPECT_EQ(one.face_energies, two.face_energies);
  }
}

TEST(Exponential, HasTheSameBitsInAnyUnitThatIsAPowerOfTwo) {
  const TriangleList mesh = meshes::cap(12, 30, 2.3);
  const Flattening plain = run(mesh, exponential(200));
  for (const int exponent : {-20, -1, 20}) {
    const double unit = std::ldexp(1.0, exponent);
    TriangleList other = mesh;
    for (Vec3& p : other.positions) p *= unit;
    const Flattening scaled = run(other, exponential(200));
    for (std::size_t v = 0; v < plain.uvs.size(); ++v) {
      ASSERT_EQ(scaled.uvs[v], Vec2(unit * plain.uvs[v])) << exponent;
    }
  }
}

TEST(Exponential, DoesNotDependOnUnitsOffsetsAndTheOrderOfFaces) {
  const TriangleList mesh = meshes::cap(12, 30, 2.3);
  const double plain = distortion(mesh, run(mesh, exponential(200)));
  for (const double scale : {1e-6, 1.0, 1e6}) {
    TriangleList other = mesh;
    for (Vec3& p : other.positions) p = scale * (p + Vec3(100, -200, 50));
    std::reverse(other.faces.begin(), other.faces.end());
    for (Triangle& t : other.faces) std::rotate(t.begin(), t.begin() + 1, t.end());
    const Flattening result = run(other, exponential(200));
    EXPECT_NEAR(distortion(other, result), plain, 1e-2 * plain) << scale;
    EXPECT_TRUE(result.certificate.injective()) << scale;
  }
}

TEST(Exponential, IsDeliveredAtItsOwnBestScale) {
  const TriangleList mesh = meshes::cap(24, 60, 2.6);
  const Flattening result = run(mesh, exponential());
  const double plain = disks::mean_exponential(mesh, result);
  for (const double factor : {0.998, 1.002}) {
    Flattening scaled = result;
    std::vector<Vec2> uvs = result.uvs;
    for (Vec2& w : uvs) w *= factor;
    measure_distortion(mesh.positions, mesh.faces, uvs, scaled.face_energies.data(), Work(1));
    EXPECT_GT(disks::mean_exponential(mesh, scaled), plain) << factor;
  }
}

/// On one mesh: by default, refined and by composite majorization alone.
void expect_promises(const std::string& name, const TriangleList& mesh) {
  const Flattening usual = run(mesh);
  ChartOptions refined = exponential(), cm = exponential();
  refined.refine = true;
  cm.method = Method::kCm;
  cm.injectivity = Injectivity::kGlobal;
  for (const ChartOptions& options : {cm, exponential(), refined}) {
    const Flattening result = run(mesh, options);
    const auto where = testing::Message() << name << ", method " << static_cast<int>(options.method)
                                          << (options.refine ? ", refined" : "");
    EXPECT_TRUE(result.certificate.injective()) << where;
    EXPECT_EQ(result.status, Outcome::kOk) << where;
    // But for roundoff, where both are isometric.
    EXPECT_LE(result.distortion.max, usual.distortion.max + 1e-6) << where;
    EXPECT_LE(exceeded_by(0.01, result), exceeded_by(0.01, usual) + 1e-6) << where;
    EXPECT_LE(distortion(mesh, result), distortion(mesh, usual) + 1e-6) << where;
  }
}

TEST(Exponential, KeepsItsPromiseAndEvensOutWhatIsWorst) {
  expect_promises("cap", meshes::cap(24, 60, 2.6));
  expect_promises("tube", disks::tube(20, 8, 1));
  expect_promises("bust", shared_data::read_obj(std::filesystem::path(BELTRAMI_SOURCE_DIR) /
                                                "examples/data/nefertiti_disk.obj"));
}

TEST(Exponential, KeepsItsPromiseAndEvensOutWhatIsWorstOnScans) {
  if (!std::filesystem::exists(shared_data::folder())) GTEST_SKIP() << "the mesh data are not here";
  for (const char* name :
       {"disks/bimba_i_f10000.obj", "disks/camelhead.obj", "disks/dragon_i_f10000.obj",
        "disks/rgb_dragon_o_f8000.obj", "hard/maze.obj"}) {
    expect_promises(name, shared_data::read_obj(shared_data::folder() / name));
  }
}

}  // namespace
}  // namespace beltrami
