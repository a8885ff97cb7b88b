// Mending fold-overs without making new ones, near-zero areas or boundary crossings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "energy/energy.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "local/kernel.h"
#include "local/patch.h"
#include "repair/global_fix.h"
#include "repair/outliers.h"
#include "repair/repair.h"
#include "repair/rounding.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;

RepairResult mend(const DiskMesh& mesh, std::vector<Vec2>& uvs) {
  return repair(mesh, disks::rest_of(mesh), uvs, {}, Work(1));
}

bool injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective();
}

double least_area(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec2 p = uvs[b] - uvs[a], q = uvs[c] - uvs[a];
    least = std::min(least, 0.5 * (p.x() * q.y() - p.y() * q.x()));
  }
  return least;
}

TEST(Repair, LeavesAGoodMapBitForBit) {
  const DiskMesh mesh = disks::disk(meshes::bumps(6, 6));
  const std::vector<Vec2> before = disks::flat_uvs(mesh);
  std::vector<Vec2> after = before;
  const RepairResult result = mend(mesh, after);
  EXPECT_EQ(after, before);
  EXPECT_EQ(result.flips_before, 0);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_EQ(result.kernel_fixes + result.patch_fixes, 0);
}

TEST(Repair, MendsOneDraggedVertexByMovingItIntoTheKernel) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  const std::vector<Vec2> before = disks::flat_uvs(mesh);
  std::vector<Vec2> after = before;
  after[24] += Vec2(0.4, 0.1);
  const RepairResult result = mend(mesh, after);
  EXPECT_GT(result.flips_before, 0);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_GE(result.kernel_fixes, 1);
  EXPECT_EQ(result.patch_fixes, 0);
  EXPECT_TRUE(injective(mesh, after));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.on_boundary[v]) {
      EXPECT_EQ(after[v], before[v]);
    }
  }
}

TEST(Repair, LeavesNoNearZeroAreas) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  const double face_area = 0.5 / 36;
  for (const double drag : {0.17, 0.1666666, 1.0 / 6, 0.3, 2.0}) {
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    uvs[24] += Vec2(drag, 0);
    if (injective(mesh, uvs)) continue;  // nothing to mend
    mend(mesh, uvs);
    EXPECT_TRUE(injective(mesh, uvs)) << drag;
    EXPECT_GT(least_area(mesh, uvs), 1e-3 * face_area) << drag;
  }
}

// Two neighbours of the dragged vertex nearly coincide, so that its kernel leaves a face of 1e-9 of
// the usual area: exactly positive, and not good enough.
TEST(Repair, RefusesAKernelThatLeavesANearZeroArea) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[25] = uvs[32] - Vec2(0, 1e-10);
  uvs[24] += Vec2(-0.3, 0.05);
  ASSERT_FALSE(injective(mesh, uvs));
  mend(mesh, uvs);
  EXPECT_TRUE(injective(mesh, uvs));
  EXPECT_GT(least_area(mesh, uvs), 1e-4 * 0.5 / 36);
}

TEST(Repair, MendsFacesThatAreExactlyCollinear) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[24] = uvs[25];
  EXPECT_GT(mend(mesh, uvs).flips_before, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(Repair, MendsSeveralFoldsAtOnce) {
  const DiskMesh mesh = disks::disk(meshes::grid(12, 12));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[3 * 13 + 3] += Vec2(0.2, 0);
  uvs[8 * 13 + 3] += Vec2(-0.1, -0.2);
  uvs[8 * 13 + 9] += Vec2(0, 0.3);
  uvs[8 * 13 + 10] += Vec2(0.02, 0.3);
  EXPECT_EQ(mend(mesh, uvs).flips_after, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

// An ear whose tip lies on the line of its base, as a straight coarse boundary edge makes it. No
// interior vertex can mend it.
TEST(Repair, MendsACollinearEarByMovingTheBoundary) {
  const DiskMesh mesh = disks::disk(meshes::grid(5, 5));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[5] = 0.5 * (uvs[4] + uvs[11]);  // the lower right corner is the tip of an ear
  const RepairResult result = mend(mesh, uvs);
  EXPECT_EQ(result.flips_before, 1);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_GE(result.patch_fixes, 1);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(Repair, MendsAnEarThatIsFoldedInwards) {
  const DiskMesh mesh = disks::disk(meshes::grid(5, 5));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[5] = {0.82, 0.18};
  mend(mesh, uvs);
  EXPECT_TRUE(injective(mesh, uvs));
}

// Slit in its middle, a saddle has too much of its surface around the slit: what relaxes there
// closes it, and its sides cross. Here they are a hair apart, and one is drawn up on itself.
TEST(Repair, HoldsTheBoundaryWhereTheSidesOfASlitWouldCross) {
  const DiskMesh mesh = disks::disk(disks::slit_saddle(2, 1.5));
  std::vector<Vec2> before = disks::flat_uvs(mesh);
  before[13].y() -= 0.0025;
  before[14].y() -= 0.005;
  before[25].y() += 0.0025;
  before[26].y() += 0.005;
  before[14] += Vec2(-0.4, -0.05);
  const Certificate folded = certify(mesh.faces, mesh.boundary, before, Work(1));
  ASSERT_EQ(folded.crossings.count, 0);
  ASSERT_EQ(folded.orientations.negative, 1);
  std::vector<Vec2> after = before;
  const RepairResult result = mend(mesh, after);
  EXPECT_EQ(result.patch_fixes, 1);
  EXPECT_EQ(result.global_fixes, 0);
  EXPECT_TRUE(injective(mesh, after));
  for (const Index v : mesh.boundary) EXPECT_EQ(after[v], before[v]);
}

// Of three vertices in the row on the boundary the middle one lies far inside and the first beyond
// it. From there faces become positive by going around a vertex twice.
TEST(Repair, StraightensABoundaryThatIsFolded) {
  const DiskMesh mesh = disks::disk(meshes::grid(5, 5));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[2] += Vec2(0.35, -0.15);
  uvs[3] += Vec2(-0.4, 0.1);
  uvs[4] += Vec2(0.25, -0.05);
  const Certificate folded = certify(mesh.faces, mesh.boundary, uvs, Work(1));
  ASSERT_EQ(folded.crossings.count, 0);
  ASSERT_EQ(folded.orientations.negative, 2);
  const RepairResult result = mend(mesh, uvs);
  EXPECT_EQ(result.patch_fixes, 1);
  EXPECT_EQ(result.global_fixes, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(Repair, MendsMeshesThatAreOnePatch) {
  const std::vector<Vec2> flipped = {{0, 0}, {0, 1}, {1, 0}};
  const DiskMesh triangle = disks::disk(meshes::triangle());
  std::vector<Vec2> uvs = flipped;
  EXPECT_EQ(mend(triangle, uvs).flips_after, 0);
  EXPECT_TRUE(injective(triangle, uvs));

  const DiskMesh quad = disks::disk(meshes::quad());
  uvs = {{0, 0}, {1, 0}, {1, 1}, {0.8, 0.2}};
  EXPECT_EQ(mend(quad, uvs).flips_after, 0);
  EXPECT_TRUE(injective(quad, uvs));
}

TEST(Repair, NeverAddsFlipsOrCrossings) {
  const DiskMesh mesh = disks::disk(meshes::grid(8, 8));
  for (int seed = 0; seed < 30; ++seed) {
    Random random(100 + seed);
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    const double noise = 0.02 * (1 + seed % 10);
    for (Vec2& w : uvs) w += noise * random.vec2();
    const Certificate before = certify(mesh.faces, mesh.boundary, uvs, Work(1));
    const RepairResult result = mend(mesh, uvs);
    const Certificate after = certify(mesh.faces, mesh.boundary, uvs, Work(1));
    EXPECT_EQ(result.flips_before, before.orientations.negative + before.orientations.degenerate);
    EXPECT_EQ(result.flips_after, after.orientations.negative + after.orientations.degenerate);
    EXPECT_LE(result.flips_after, result.flips_before) << seed;
    EXPECT_LE(after.crossings.count, before.crossings.count) << seed;
  }
}

TEST(Repair, HasTheSameBitsOnTwoThreads) {
  Random random(1);
  const DiskMesh mesh = disks::disk(meshes::grid(70, 70));
  std::vector<Vec2> one = disks::flat_uvs(mesh);
  for (int i = 0; i < 20; ++i) one[random.below(mesh.vertex_count())] += 0.03 * random.vec2();
  std::vector<Vec2> two = one;
  const auto rest = disks::rest_of(mesh);
  repair(mesh, rest, one, {}, Work(1));
  repair(mesh, rest, two, {}, Work(2));
  EXPECT_EQ(one, two);
}

// ---- Global fix ---------------------------------------------------------------------------

TEST(GlobalFix, ReproducesALayoutThatIsInjective) {
  const DiskMesh mesh = disks::disk(meshes::bumps(9, 7));
  const std::vector<Vec2> before = disks::flat_uvs(mesh);
  std::vector<Vec2> after = before;
  ASSERT_TRUE(embed_with_scaffold(mesh, after, Work(1)));
  for (std::size_t v = 0; v < after.size(); ++v) EXPECT_LT((after[v] - before[v]).norm(), 1e-9);
}

TEST(GlobalFix, EmbedsAnyLayout) {
  const DiskMesh mesh = disks::disk(meshes::grid(10, 10));
  for (int seed = 0; seed < 20; ++seed) {
    Random random(500 + seed);
    std::vector<Vec2> uvs;
    for (Index v = 0; v < mesh.vertex_count(); ++v) uvs.push_back(random.vec2());
    ASSERT_TRUE(embed_with_scaffold(mesh, uvs, Work(1)));
    EXPECT_TRUE(injective(mesh, uvs)) << seed;
  }
  // Nothing to go by at all: every vertex in one place.
  std::vector<Vec2> uvs(mesh.positions.size(), Vec2(0.25, 0.5));
  ASSERT_TRUE(embed_with_scaffold(mesh, uvs, Work(1)));
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(GlobalFix, EndsOnRequest) {
  const DiskMesh mesh = disks::disk(meshes::grid(10, 10));
  const std::vector<Vec2> before = disks::flat_uvs(mesh);
  std::vector<Vec2> uvs = before;
  const std::atomic<bool> request{true};
  const InterruptScope scope(&request);
  EXPECT_THROW(embed_with_scaffold(mesh, uvs, Work(1)), Cancelled);
  EXPECT_EQ(uvs, before);
}

TEST(GlobalFix, IsTheRungAfterPatches) {
  const DiskMesh mesh = disks::disk(meshes::grid(40, 40));
  // More folds than patches are tried for.
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {portable::cos(9 * w.x()) + 0.3 * w.y(), w.y() - 0.2 * w.x()};
  const RepairResult result = mend(mesh, uvs);
  EXPECT_GT(result.flips_before, 1000);
  EXPECT_EQ(result.global_fixes, 1);
  EXPECT_EQ(result.patch_fixes, 0);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(GlobalFix, OpensABoundaryThatCrossesItselfOnDemandOnly) {
  const DiskMesh mesh = disks::disk(meshes::strip(24));
  // Bent through more than a turn: no face is flipped, the ends overlap.
  std::vector<Vec2> bent = disks::flat_uvs(mesh);
  for (Vec2& w : bent) {
    const double angle = -7.5 * w.x(), radius = 1 + 0.5 * w.y();
    w = {radius * portable::sin(angle), -radius * portable::cos(angle)};
  }
  std::vector<Vec2> uvs = bent;
  EXPECT_EQ(mend(mesh, uvs).flips_before, 0);
  EXPECT_EQ(uvs, bent);
  ASSERT_GT(certify(mesh.faces, mesh.boundary, bent, Work(1)).crossings.count, 0);
  const auto rest = disks::rest_of(mesh);
  EXPECT_EQ(repair(mesh, rest, uvs, {.simple_boundary = true}, Work(1)).global_fixes, 1);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(Repair, MovesNeighboursFirstWhereAKernelIsEmpty) {
  const DiskMesh mesh = disks::disk(meshes::grid(12, 12));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  // Two neighbours that changed places: no kernel until one of them has moved out of the way.
  std::swap(uvs[6 * 13 + 6], uvs[6 * 13 + 7]);
  const RepairResult result = mend(mesh, uvs);
  EXPECT_GT(result.flips_before, 0);
  EXPECT_EQ(result.flips_after, 0);
  EXPECT_EQ(result.global_fixes, 0);
  EXPECT_TRUE(injective(mesh, uvs));
}

// ---- Outliers -------------------------------------------------------------------------------

/// A flat grid with a face squeezed to nearly nothing.
std::vector<Vec2> squeezed(const DiskMesh& mesh) {
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[24] += (1 - 1e-9) * (uvs[25] - uvs[24]);
  return uvs;
}

double energy_of(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(1)).symmetric_dirichlet;
}

TEST(CleanOutliers, MendsAFaceOfEnormousEnergy) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs = squeezed(mesh);
  EXPECT_GT(energy_of(mesh, uvs), 1e10);
  EXPECT_GE(
      clean_outliers(Energy::kSymmetricDirichlet, mesh, disks::rest_of(mesh), uvs, {}, Work(1)), 1);
  EXPECT_LT(energy_of(mesh, uvs), 20);
  EXPECT_TRUE(injective(mesh, uvs));
}

TEST(CleanOutliers, LeavesAMapWithoutOutliersBitForBit) {
  const DiskMesh mesh = disks::disk(meshes::bumps(6, 6));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  EXPECT_EQ(
      clean_outliers(Energy::kSymmetricDirichlet, mesh, disks::rest_of(mesh), uvs, {}, Work(1)), 0);
  EXPECT_EQ(uvs, disks::flat_uvs(mesh));
}

// ---- Hubs -----------------------------------------------------------------------------------

/// A fan whose every second face is flipped by a rim that goes back and forth.
std::vector<Vec2> folded_fan(Index faces) {
  std::vector<Vec2> uvs = {{0, 0}};
  for (Index i = 0; i < faces; ++i) {
    const double angle = 2 * std::numbers::pi * (i % 2 == 0 ? i : i - 1.5) / faces;
    uvs.push_back({std::cos(angle), std::sin(angle)});
  }
  return uvs;
}

TEST(CutPatch, GoesAroundEachVertexOnce) {
  const auto polls = [](Index faces) {
    const DiskMesh mesh = disks::disk(meshes::fan(faces));
    const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    return count_polls([&] { cut_patch(mesh, {}, uvs, 0, 4); });
  };
  // A thousand faces at a vertex are the most that it goes around.
  EXPECT_LE(polls(1000), 40);
  EXPECT_LE(polls(100000), 2 * polls(1000) + 2);
}

TEST(CutPatch, LeavesAHubWhereItIs) {
  const DiskMesh mesh = disks::disk(meshes::fan(3000));
  const Patch patch = cut_patch(mesh, {}, disks::flat_uvs(mesh), 7, 2);
  EXPECT_LT(patch.faces.size(), 10u);
  for (std::size_t v = 0; v < patch.mesh_vertices.size(); ++v) {
    EXPECT_TRUE(patch.mesh_vertices[v] != 0 || patch.fixed[v]);
  }
}

TEST(Repair, TakesLittleMoreThanTwiceTheWorkForAHubOfTwiceTheFaces) {
  const auto polls = [](Index faces) {
    const DiskMesh mesh = disks::disk(meshes::fan(faces));
    std::vector<Vec2> uvs = folded_fan(faces);
    const auto rest = disks::rest_of(mesh);
    return count_polls([&] { repair(mesh, rest, uvs, {}, Work(1)); });
  };
  EXPECT_LE(polls(16000), 3 * polls(8000));
}

TEST(RoundMap, TakesLittleMoreThanTwiceTheWorkForAHubOfTwiceTheFaces) {
  const auto polls = [](Index faces) {
    const DiskMesh mesh = disks::disk(meshes::fan(faces));
    std::vector<Vec2> uvs;
    // Slivers far from the origin: rounding flips very many.
    for (const Vec2& w : disks::flat_uvs(mesh)) uvs.push_back(w + Vec2(300, 200));
    EXPECT_TRUE(injective(mesh, uvs));
    return count_polls([&] { round_map(mesh, uvs, uvs, {.single = true}, Work(1)); });
  };
  EXPECT_LE(polls(40000), 3 * polls(20000));
}

TEST(KernelCentroid, SeesAllOfAPolygonOfVeryManyCorners) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20000;
    polygon.push_back({3 + std::cos(angle), 2 * std::sin(angle)});
  }
  const auto centre = kernel_centroid(polygon);
  ASSERT_TRUE(centre);
  EXPECT_LT((*centre - Vec2(3, 0)).norm(), 0.1);
}

}  // namespace
}  // namespace beltrami
