// What each way of flattening promises, from coarse to fine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "energy/energy.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"
#include "support/polls.h"
#include "support/run.h"

namespace beltrami {
namespace {

using disks::run;
using meshes::TriangleList;

ChartOptions coarse_to_fine(Flatten how, Energy energy = Energy::kSymmetricDirichlet) {
  ChartOptions options;
  options.coarse_faces = 300;
  options.flatten = how;
  options.energy = energy;
  return options;
}

ChartOptions method(Method which, Energy energy = Energy::kSymmetricDirichlet) {
  ChartOptions options;
  options.coarse_faces = 300;
  options.method = which;
  options.energy = energy;
  return options;
}

std::int64_t flips(const Flattening& result) {
  return result.certificate.orientations.negative + result.certificate.orientations.degenerate;
}

struct NamedMesh {
  std::string name;
  TriangleList mesh;
};

std::vector<NamedMesh> models() {
  return {{"bumps", meshes::bumps(30, 30)},
          {"cap", meshes::cap(24, 60, 2.6)},
          {"ramp", disks::ramp(80, 8)},
          {"dumbbell", disks::dumbbell(14)},
          {"slivers", disks::slivers(26, 26)}};
}

TEST(Modes, KeepTheirPromises) {
  for (const auto& [name, mesh] : models()) {
    for (const Energy energy : disks::kEnergies) {
      for (const Flatten how : {Flatten::kMetric, Flatten::kDirichlet, Flatten::kGif}) {
        const Flattening result = run(mesh, coarse_to_fine(how, energy));
        EXPECT_TRUE(result.certificate.injective()) << name << ", flatten " << static_cast<int>(how)
                                                    << ", energy " << static_cast<int>(energy);
      }
      EXPECT_EQ(flips(run(mesh, coarse_to_fine(Flatten::kFlim, energy))), 0) << name;
    }
    EXPECT_TRUE(run(mesh, method(Method::kGif)).certificate.injective()) << name;
  }
}

TEST(Modes, ThatPromiseNothingReportTheirFlips) {
  for (const auto& [name, mesh] : models()) {
    for (const ChartOptions& options :
         {coarse_to_fine(Flatten::kBff), method(Method::kBff), method(Method::kUvProlongation)}) {
      const Flattening result = run(mesh, options);
      EXPECT_EQ(result.statistics.flips_before_repair, flips(result)) << name;
      EXPECT_EQ(result.status == Outcome::kOk, result.certificate.injective()) << name;
      for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite()) << name;
    }
  }
}

TEST(Modes, UvProlongationFlipsWhereThePipelineDoesNot) {
  const TriangleList mesh = meshes::height_field(50, 50, [](double x, double y) {
    return 0.3 * portable::sin(25 * x) * portable::sin(25 * y);
  });
  EXPECT_GT(flips(run(mesh, method(Method::kUvProlongation))), 0);
  EXPECT_TRUE(run(mesh, coarse_to_fine(Flatten::kMetric)).certificate.injective());
}

TEST(Modes, LocalInjectivityLetsARampCoverItself) {
  const TriangleList mesh = disks::ramp(80, 8);
  ChartOptions options = coarse_to_fine(Flatten::kMetric);
  const Flattening global = run(mesh, options);
  options.injectivity = Injectivity::kLocal;
  const Flattening local = run(mesh, options);
  EXPECT_EQ(flips(local), 0);
  EXPECT_GT(local.certificate.crossings.count, 0);
  EXPECT_EQ(local.status, Outcome::kNotInjective);
  EXPECT_TRUE(global.certificate.injective());
  EXPECT_LT(local.distortion.symmetric_dirichlet, global.distortion.symmetric_dirichlet);
}

TEST(Modes, ComeCloseToTheMinimumOfTheirEnergy) {
  for (const NamedMesh& model : models()) {
    if (model.name == "ramp") continue;  // the reference covers itself
    const auto dirichlet = [&](const ChartOptions& options) {
      return run(model.mesh, options).distortion.symmetric_dirichlet;
    };
    const double minimum = dirichlet(method(Method::kCm));
    EXPECT_LE(dirichlet(coarse_to_fine(Flatten::kMetric)), 1.005 * minimum) << model.name;
    EXPECT_LE(dirichlet(coarse_to_fine(Flatten::kGif)), 1.1 * minimum) << model.name;
    const auto arap = [&](const ChartOptions& options) {
      return run(model.mesh, options).distortion.symmetric_arap;
    };
    EXPECT_LE(arap(coarse_to_fine(Flatten::kMetric, Energy::kSymmetricArap)),
              1.02 * arap(method(Method::kCm, Energy::kSymmetricArap)) + 1e-4)
        << model.name;
    constexpr Energy kExponential = Energy::kExponentialDirichlet;
    const auto exponential = [&](const ChartOptions& options) {
      return disks::distortion(kExponential, model.mesh, run(model.mesh, options));
    };
    EXPECT_LE(exponential(coarse_to_fine(Flatten::kMetric, kExponential)),
              1.01 * exponential(method(Method::kCm, kExponential)))
        << model.name;
  }
}

TEST(Refine, ReachesTheMinimumAndNeverRisesAboveItsStart) {
  const TriangleList mesh = meshes::cap(24, 60, 2.6);
  const double minimum = run(mesh, method(Method::kCm)).distortion.symmetric_dirichlet;
  for (const Flatten how : {Flatten::kMetric, Flatten::kDirichlet}) {
    ChartOptions options = coarse_to_fine(how);
    const double start = run(mesh, options).distortion.symmetric_dirichlet;
    options.refine = true;
    const Flattening refined = run(mesh, options);
    EXPECT_TRUE(refined.certificate.injective());
    EXPECT_LE(refined.distortion.symmetric_dirichlet, start * (1 + 1e-12));
    EXPECT_LE(refined.distortion.symmetric_dirichlet, 1.0005 * minimum);
  }
}

TEST(Refine, KeepsToItsIterationsAndReturnsTheBestMapSoFar) {
  const TriangleList mesh = meshes::cap(24, 60, 2.6);
  ChartOptions options = coarse_to_fine(Flatten::kDirichlet);
  const double start = run(mesh, options).distortion.symmetric_dirichlet;
  options.refine = true;
  options.refine_iterations = 1;
  const Flattening once = run(mesh, options);
  EXPECT_EQ(once.status, Outcome::kOk);
  const auto stage = std::find_if(once.statistics.stages.begin(), once.statistics.stages.end(),
                                  [](const auto& s) { return std::string(s.name) == "refine"; });
  ASSERT_NE(stage, once.statistics.stages.end());
  EXPECT_EQ(stage->iterations, 1);
  EXPECT_LT(once.distortion.symmetric_dirichlet, start);
}

// ---- Time and cancelling
// -----------------------------------------------------------------------------

std::vector<ChartOptions> all_modes() {
  std::vector<ChartOptions> modes;
  for (const Flatten how :
       {Flatten::kMetric, Flatten::kDirichlet, Flatten::kGif, Flatten::kFlim, Flatten::kBff}) {
    modes.push_back(coarse_to_fine(how));
  }
  for (const Method which :
       {Method::kCm, Method::kTutte, Method::kGif, Method::kBff, Method::kUvProlongation}) {
    modes.push_back(method(which));
  }
  modes.push_back(coarse_to_fine(Flatten::kMetric, Energy::kSymmetricArap));
  modes.push_back(coarse_to_fine(Flatten::kMetric, Energy::kExponentialDirichlet));
  modes.push_back(coarse_to_fine(Flatten::kMetric));
  modes.back().delaunay = true;
  modes.push_back(coarse_to_fine(Flatten::kMetric));
  modes.back().refine = modes.back().float32 = true;
  for (ChartOptions& options : modes) options.coarse_faces = 100;
  return modes;
}

/// Whether the map is injective whatever the mesh.
bool is_injective(const ChartOptions& options) {
  return promises(options) || options.method == Method::kCm || options.method == Method::kTutte ||
         options.method == Method::kGif;
}

TEST(Modes, EndWithAnInjectiveMapWhenTheTimeIsUp) {
  const TriangleList mesh = meshes::cap(16, 40, 2.6);
  for (const ChartOptions& options : all_modes()) {
    const std::string where = "method " + std::to_string(static_cast<int>(options.method)) +
                              ", flatten " + std::to_string(static_cast<int>(options.flatten));
    const Flattening result = run(mesh, options, Work({.seconds = 1e-9}, {}));
    EXPECT_TRUE(result.certificate.injective() || !is_injective(options)) << where;
    const bool iterates = options.method == Method::kCm || promises(options);
    EXPECT_TRUE(result.status == Outcome::kNotConverged || !iterates) << where;
    for (const StageStatistics& stage : result.statistics.stages) {
      const std::string name = stage.name;
      const bool newton = name == "coarse" || name == "cm" || name == "refine";
      EXPECT_TRUE(stage.iterations == 0 || !newton) << where << ", " << name;
      EXPECT_TRUE(stage.iterations <= 1 || name != "polish") << where;
    }
  }
}

TEST(Modes, TakeAllTheirStepsWithinALimitThatIsFarAway) {
  const TriangleList mesh = meshes::bumps(14, 14);
  for (const ChartOptions& options : all_modes()) {
    const Flattening free = run(mesh, options),
                     limited = run(mesh, options, Work({.seconds = 1e9}, {}));
    EXPECT_EQ(free.uvs, limited.uvs);
    EXPECT_EQ(free.status, limited.status);
  }
}

/// Where cancels are tried: at each of the first polls, then at some of each stretch, to the last.
std::vector<std::int64_t> moments(std::int64_t polls) {
  std::vector<std::int64_t> moments;
  for (std::int64_t k = 1; k <= polls; k += 1 + k / 12) moments.push_back(k);
  moments.push_back(polls);
  return moments;
}

TEST(Modes, AreCancelledAtAnyPollAndNeverEndInAnotherWay) {
  // The ramp needs a repair, a scaffold and restarts in some modes.
  for (const TriangleList& mesh : {meshes::bumps(14, 14), disks::ramp(24, 4)}) {
    for (const ChartOptions& options : all_modes()) {
      const std::string where = "method " + std::to_string(static_cast<int>(options.method)) +
                                ", flatten " + std::to_string(static_cast<int>(options.flatten)) +
                                ", " + std::to_string(mesh.faces.size()) + " faces";
      const std::int64_t polls = count_polls([&] { run(mesh, options); });
      for (const std::int64_t k : moments(polls)) {
        EXPECT_THROW(count_polls([&] { run(mesh, options); }, k), Cancelled)
            << "poll " << k << " of " << polls << ", " << where;
      }
    }
  }
}

}  // namespace
}  // namespace beltrami
