#include "multilevel/anchors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/work.h"
#include "exact/crossings.h"
#include "simplify/simplify.h"
#include "support/cuts.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// A map of a grid in which one boundary vertex lies beyond the opposite side, unless it is
/// anchored.
class Solves {
 public:
  explicit Solves(const DiskMesh& mesh) : flat_(disks::flat_uvs(mesh)), stray_(mesh.boundary[3]) {}

  bool operator()() {
    ++calls;
    uvs = flat_;
    if (anchored.empty() || !anchored[stray_]) uvs[stray_] += Vec2(0, 100);
    return true;
  }

  Index stray() const { return stray_; }

  std::vector<Vec2> uvs;
  std::vector<bool> anchored;
  int calls = 0;

 private:
  const std::vector<Vec2> flat_;
  const Index stray_;
};

std::ptrdiff_t count(const std::vector<bool>& anchored) {
  return std::count(anchored.begin(), anchored.end(), true);
}

TEST(SolveUntilSimple, AnchorsWhatCrosses) {
  const DiskMesh mesh = disks::disk(meshes::grid(60, 60));
  Solves solve(mesh);
  EXPECT_TRUE(solve_until_simple(mesh, solve.uvs, solve.anchored, [&] { return solve(); }));
  EXPECT_TRUE(is_simple(mesh.boundary, solve.uvs));
  EXPECT_TRUE(solve.anchored[solve.stray()]);
  // And no more than a few around it.
  EXPECT_LT(count(solve.anchored), 20);
  EXPECT_EQ(solve.calls, 2);
}

TEST(SolveUntilSimple, AnchorsNothingWhereNothingCrosses) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs;
  std::vector<bool> anchored;
  EXPECT_TRUE(solve_until_simple(mesh, uvs, anchored, [&] {
    uvs = disks::flat_uvs(mesh);
    return true;
  }));
  EXPECT_TRUE(anchored.empty());
}

TEST(SolveUntilSimple, EndsWhereTheWholeBoundaryIsAnchored) {
  const DiskMesh mesh = disks::disk(meshes::grid(60, 60));
  Solves solve(mesh);
  const auto stubborn = [&] {
    solve();
    solve.uvs[solve.stray()] += Vec2(0, 100);
    return true;
  };
  EXPECT_FALSE(solve_until_simple(mesh, solve.uvs, solve.anchored, stubborn));
  EXPECT_EQ(count(solve.anchored), static_cast<std::ptrdiff_t>(mesh.boundary.size()));
  EXPECT_LE(solve.calls, 10);
}

TEST(SolveUntilSimple, EndsWhereItIsNotWorthGoingOn) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  Solves solve(mesh);
  EXPECT_FALSE(solve_until_simple(mesh, solve.uvs, solve.anchored, [&] {
    solve();
    return false;
  }));
  EXPECT_EQ(solve.calls, 1);
}

TEST(VerticesInContact, AreThoseOfTheCoarseMeshThatAreNearOtherParts) {
  // Laid out flat, the sides of the slit are a rounding error apart; the outer sides are not.
  const DiskMesh mesh = disks::disk(disks::refined(disks::slit_saddle(8, 0), 2));
  const CoarseDisk coarse = simplify(mesh, mesh.face_count() / 4, Work(1));
  std::vector<Vec2> uvs;
  for (const Vec3& p : coarse.mesh.positions) uvs.emplace_back(p.x(), p.y());
  const std::vector<bool> found = vertices_in_contact(coarse, uvs, mesh.vertex_count());
  EXPECT_GT(count(found), 0);
  std::vector<bool> kept(mesh.vertex_count(), false);
  for (const Index v : coarse.fine_vertex) kept[v] = true;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_TRUE(!found[v] || (kept[v] && mesh.on_boundary[v])) << v;
  }
  EXPECT_LT(2 * count(found), static_cast<std::ptrdiff_t>(coarse.mesh.boundary.size()));
}

}  // namespace
}  // namespace beltrami
