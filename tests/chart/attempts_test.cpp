// Of several attempts the best is kept whole, and no other leaves a trace but its time.
#include "chart/attempts.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/vectors.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

struct Input {
  DiskMesh disk;
  Normalisation frame;
};

Input flat_grid() {
  meshes::TriangleList mesh = meshes::grid(3, 3);
  const Normalisation frame = normalise(mesh.positions, mesh.faces, Work(1));
  return {disks::disk(std::move(mesh)), frame};
}

/// The isometry of a flat mesh.
ChartMap isometry(const DiskMesh& disk) {
  ChartMap map;
  for (const Vec3& p : disk.positions) map.uvs.emplace_back(p.x(), p.y());
  map.statistics.stages.push_back({"isometry", 3});
  map.statistics.coarse_faces = 5;
  return map;
}

/// With a vertex pulled over the others: `far` tells how many faces flip.
ChartMap folded(const DiskMesh& disk, double far) {
  ChartMap map = isometry(disk);
  map.uvs[disk.boundary[0]] += Vec2(far, far);
  map.converged = false;
  map.statistics = {};
  map.statistics.stages.push_back({"folded", 7});
  map.statistics.coarse_faces = 99;
  map.statistics.coarse_energy = 42;
  map.statistics.flips_before_repair = map.statistics.kernel_fixes = 8;
  map.statistics.patch_fixes = map.statistics.global_fixes = map.statistics.cleaned_patches = 9;
  map.statistics.delaunay_flips = map.statistics.delaunay_refused = 10;
  return map;
}

/// All faces clockwise: the most faults that a map can have.
ChartMap mirrored(const DiskMesh& disk) {
  ChartMap map = folded(disk, 0);
  for (Vec2& w : map.uvs) w.x() = -w.x();
  map.statistics.stages = {{"mirrored", 7}};
  return map;
}

std::vector<std::string> stage_names(const Attempts& tried) {
  std::vector<std::string> names;
  for (const StageStatistics& stage : tried.best.map.statistics.stages) {
    names.emplace_back(stage.name);
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(Attempts, ThatFailLeaveNoTraceInWhatIsKept) {
  const auto [disk, frame] = flat_grid();
  const Way bad{[&disk = disk](const Work&) { return mirrored(disk); }};
  const Way good{[&disk = disk](const Work&) { return isometry(disk); }};
  const Attempts alone = try_in_turn(disk, frame, {good}, {}, Work());
  const Attempts second = try_in_turn(disk, frame, {bad, good}, {}, Work());
  EXPECT_EQ(alone.restarts, 0);
  EXPECT_EQ(second.restarts, 1);
  EXPECT_TRUE(second.best.map.converged);
  EXPECT_EQ(second.best.broken, 0);
  EXPECT_EQ(second.best.delivery.uvs, alone.best.delivery.uvs);
  const ChartStatistics& kept = second.best.map.statistics;
  EXPECT_EQ(kept.coarse_faces, 5);
  EXPECT_EQ(kept.coarse_energy, 0);
  for (const std::int64_t count :
       {kept.flips_before_repair, kept.kernel_fixes, kept.patch_fixes, kept.global_fixes,
        kept.cleaned_patches, kept.delaunay_flips, kept.delaunay_refused}) {
    EXPECT_EQ(count, 0);
  }
  EXPECT_EQ(stage_names(alone), (Names{"isometry", "certify"}));
  EXPECT_EQ(stage_names(second), (Names{"given-up", "isometry", "certify"}));
  EXPECT_GT(kept.stages.front().seconds, 0);
}

TEST(Attempts, KeepTheOneWithTheFewestFaultsWholeWhereNoneIsRight) {
  const auto [disk, frame] = flat_grid();
  const Way worst{[&disk = disk](const Work&) { return mirrored(disk); }};
  const Way better{[&disk = disk](const Work&) { return folded(disk, 3); }};
  for (const auto& ways : {std::vector<Way>{worst, better}, std::vector<Way>{better, worst}}) {
    const Attempts tried = try_in_turn(disk, frame, ways, {}, Work());
    EXPECT_GT(tried.best.broken, 0);
    EXPECT_LT(tried.best.broken, disk.face_count());
    EXPECT_FALSE(tried.best.map.converged);
    EXPECT_EQ(tried.best.map.statistics.coarse_faces, 99);
    EXPECT_EQ(stage_names(tried), (Names{"given-up", "folded", "certify"}));
  }
}

TEST(Attempts, PassOverWaysThatFailAndEndWithTheLastErrorWhereAllDo) {
  const auto [disk, frame] = flat_grid();
  const Way failing{
      [](const Work&) -> ChartMap { throw Error(Fault::kSolver, "take another method"); }};
  const Way good{[&disk = disk](const Work&) { return isometry(disk); }};
  EXPECT_EQ(try_in_turn(disk, frame, {failing, good}, {}, Work()).best.broken, 0);
  EXPECT_THROW(try_in_turn(disk, frame, {failing, failing}, {}, Work()), Error);
}

TEST(Attempts, ThatNeedTimeAreLeftOutWhenItIsUp) {
  const auto [disk, frame] = flat_grid();
  int slow_runs = 0;
  const Way bad{[&disk = disk](const Work&) { return mirrored(disk); }};
  const Way slow{[&, &disk = disk](const Work&) {
                   ++slow_runs;
                   return isometry(disk);
                 },
                 true};
  const Way quick{[&disk = disk](const Work&) { return isometry(disk); }};
  const Work hurried({.seconds = 1e-9}, {});
  EXPECT_EQ(try_in_turn(disk, frame, {bad, slow, quick}, {}, hurried).best.broken, 0);
  EXPECT_EQ(slow_runs, 0);
  EXPECT_EQ(try_in_turn(disk, frame, {slow}, {}, hurried).best.broken, 0);
  EXPECT_EQ(slow_runs, 1) << "the first way is always gone";
}

}  // namespace
}  // namespace beltrami
