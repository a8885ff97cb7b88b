// What each way of flattening promises, from coarse to fine.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "chart/pipeline.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Flattening run(TriangleList mesh, const Options& options) {
  const Normalisation frame = normalise(mesh.positions, mesh.faces);
  const DiskMesh disk = disks::disk(std::move(mesh));
  const std::atomic<bool> cancelled{false};
  return flatten(disk, frame, options, {}, cancelled);
}

Options coarse_to_fine(std::int32_t how,
                       std::int32_t energy = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET) {
  Options options;
  options.coarse_faces = 300;
  options.flatten = how;
  options.energy = energy;
  return options;
}

Options method(std::int32_t which, std::int32_t energy = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET) {
  Options options;
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
    for (const std::int32_t energy :
         {BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET, BELTRAMI_ENERGY_SYMMETRIC_ARAP}) {
      for (const std::int32_t how :
           {BELTRAMI_FLATTEN_METRIC, BELTRAMI_FLATTEN_DIRICHLET, BELTRAMI_FLATTEN_GIF}) {
        const Flattening result = run(mesh, coarse_to_fine(how, energy));
        EXPECT_TRUE(result.certificate.injective()) << name << ", flatten " << how;
      }
      EXPECT_EQ(flips(run(mesh, coarse_to_fine(BELTRAMI_FLATTEN_FLIM, energy))), 0) << name;
    }
    EXPECT_TRUE(run(mesh, method(BELTRAMI_METHOD_GIF)).certificate.injective()) << name;
  }
}

TEST(Modes, ThatPromiseNothingReportTheirFlips) {
  for (const auto& [name, mesh] : models()) {
    for (const Options& options :
         {coarse_to_fine(BELTRAMI_FLATTEN_BFF), method(BELTRAMI_METHOD_BFF),
          method(BELTRAMI_METHOD_UV_PROLONGATION)}) {
      const Flattening result = run(mesh, options);
      EXPECT_EQ(result.flips_before_repair, flips(result)) << name;
      EXPECT_EQ(result.status == BELTRAMI_OK, result.certificate.injective()) << name;
      for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite()) << name;
    }
  }
}

TEST(Modes, UvProlongationFlipsWhereThePipelineDoesNot) {
  const TriangleList mesh = meshes::height_field(50, 50, [](double x, double y) {
    return 0.3 * portable::sin(25 * x) * portable::sin(25 * y);
  });
  EXPECT_GT(flips(run(mesh, method(BELTRAMI_METHOD_UV_PROLONGATION))), 0);
  EXPECT_TRUE(run(mesh, coarse_to_fine(BELTRAMI_FLATTEN_METRIC)).certificate.injective());
}

TEST(Modes, LocalInjectivityLetsARampCoverItself) {
  const TriangleList mesh = disks::ramp(80, 8);
  Options options = coarse_to_fine(BELTRAMI_FLATTEN_METRIC);
  const Flattening global = run(mesh, options);
  options.injectivity = BELTRAMI_INJECTIVITY_LOCAL;
  const Flattening local = run(mesh, options);
  EXPECT_EQ(flips(local), 0);
  EXPECT_GT(local.certificate.crossings.count, 0);
  EXPECT_EQ(local.status, BELTRAMI_NOT_INJECTIVE);
  EXPECT_TRUE(global.certificate.injective());
  EXPECT_LT(local.distortion.symmetric_dirichlet, global.distortion.symmetric_dirichlet);
}

TEST(Modes, ComeCloseToTheMinimumOfTheirEnergy) {
  for (const auto& [name, mesh] : models()) {
    if (name == "ramp") continue;  // the reference covers itself
    const auto dirichlet = [&](const Options& options) {
      return run(mesh, options).distortion.symmetric_dirichlet;
    };
    const double minimum = dirichlet(method(BELTRAMI_METHOD_CM));
    EXPECT_LE(dirichlet(coarse_to_fine(BELTRAMI_FLATTEN_METRIC)), 1.005 * minimum) << name;
    EXPECT_LE(dirichlet(coarse_to_fine(BELTRAMI_FLATTEN_GIF)), 1.1 * minimum) << name;
    const auto arap = [&](const Options& options) {
      return run(mesh, options).distortion.symmetric_arap;
    };
    EXPECT_LE(arap(coarse_to_fine(BELTRAMI_FLATTEN_METRIC, BELTRAMI_ENERGY_SYMMETRIC_ARAP)),
              1.02 * arap(method(BELTRAMI_METHOD_CM, BELTRAMI_ENERGY_SYMMETRIC_ARAP)) + 1e-4)
        << name;
  }
}

TEST(Refine, ReachesTheMinimumAndNeverRisesAboveItsStart) {
  const TriangleList mesh = meshes::cap(24, 60, 2.6);
  const double minimum = run(mesh, method(BELTRAMI_METHOD_CM)).distortion.symmetric_dirichlet;
  for (const std::int32_t how : {BELTRAMI_FLATTEN_METRIC, BELTRAMI_FLATTEN_DIRICHLET}) {
    Options options = coarse_to_fine(how);
    const double start = run(mesh, options).distortion.symmetric_dirichlet;
    options.refine = true;
    const Flattening refined = run(mesh, options);
    EXPECT_TRUE(refined.certificate.injective());
    EXPECT_LE(refined.distortion.symmetric_dirichlet, start * (1 + 1e-12));
    EXPECT_LE(refined.distortion.symmetric_dirichlet, 1.0005 * minimum);
  }
}

TEST(Refine, KeepsToItsLimitsAndReturnsTheBestMapSoFar) {
  const TriangleList mesh = meshes::cap(24, 60, 2.6);
  Options options = coarse_to_fine(BELTRAMI_FLATTEN_DIRICHLET);
  const double start = run(mesh, options).distortion.symmetric_dirichlet;
  options.refine = true;
  options.refine_iterations = 1;
  const Flattening once = run(mesh, options);
  EXPECT_EQ(once.status, BELTRAMI_OK);
  const auto stage = std::find_if(once.stages.begin(), once.stages.end(),
                                  [](const auto& s) { return std::string(s.name) == "refine"; });
  ASSERT_NE(stage, once.stages.end());
  EXPECT_EQ(stage->iterations, 1);
  EXPECT_LT(once.distortion.symmetric_dirichlet, start);

  options.refine_iterations = 0;
  options.time_limit = 1e-9;
  const Flattening none = run(mesh, options);
  EXPECT_EQ(none.status, BELTRAMI_OK);
  EXPECT_TRUE(none.certificate.injective());
  EXPECT_EQ(none.distortion.symmetric_dirichlet, start);
}

// ---- Cancelling -----------------------------------------------------------------------------

std::vector<Options> all_modes() {
  std::vector<Options> modes;
  for (const std::int32_t how :
       {BELTRAMI_FLATTEN_METRIC, BELTRAMI_FLATTEN_DIRICHLET, BELTRAMI_FLATTEN_GIF,
        BELTRAMI_FLATTEN_FLIM, BELTRAMI_FLATTEN_BFF}) {
    modes.push_back(coarse_to_fine(how));
  }
  for (const std::int32_t which : {BELTRAMI_METHOD_CM, BELTRAMI_METHOD_TUTTE, BELTRAMI_METHOD_GIF,
                                   BELTRAMI_METHOD_BFF, BELTRAMI_METHOD_UV_PROLONGATION}) {
    modes.push_back(method(which));
  }
  modes.push_back(coarse_to_fine(BELTRAMI_FLATTEN_METRIC, BELTRAMI_ENERGY_SYMMETRIC_ARAP));
  modes.push_back(coarse_to_fine(BELTRAMI_FLATTEN_METRIC));
  modes.back().delaunay = true;
  modes.push_back(coarse_to_fine(BELTRAMI_FLATTEN_METRIC));
  modes.back().refine = modes.back().float32 = true;
  for (Options& options : modes) options.coarse_faces = 100;
  return modes;
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
    for (const Options& options : all_modes()) {
      const std::string where = "method " + std::to_string(options.method) + ", flatten " +
                                std::to_string(options.flatten) + ", " +
                                std::to_string(mesh.faces.size()) + " faces";
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
