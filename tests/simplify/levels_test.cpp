// A disk in levels.
#include "simplify/levels.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "simplify/simplify.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(CoarserLevels, EachIsADiskOnVerticesOfTheOneBefore) {
  const DiskMesh fine = disks::disk(meshes::bumps(90, 90));
  const auto levels = coarser_levels(fine, std::nullopt, 200, Work(1));
  ASSERT_EQ(levels.size(), 2u);
  const DiskMesh* last = &fine;
  for (const CoarseDisk& level : levels) {
    EXPECT_LE(level.mesh.face_count(), 0.2 * last->face_count());
    ASSERT_EQ(level.nearby.size(), last->positions.size());
    for (Index c = 0; c < level.mesh.vertex_count(); ++c) {
      EXPECT_EQ(level.mesh.positions[c], last->positions[level.fine_vertex[c]]);
      EXPECT_EQ(level.nearby[level.fine_vertex[c]], c);
    }
    // Along the boundary the vertices left come in the same order.
    Index at = 0;
    while (last->boundary[at] != level.fine_vertex[level.mesh.boundary.front()]) ++at;
    for (const Index c : level.mesh.boundary) {
      Index steps = 0;
      for (; last->boundary[at] != level.fine_vertex[c]; ++steps) {
        at = at + 1 == size_of(last->boundary) ? 0 : at + 1;
        ASSERT_LT(steps, size_of(last->boundary));
      }
    }
    last = &level.mesh;
  }
}

TEST(CoarserLevels, GoOnFromALevelThatIsKnown) {
  const DiskMesh fine = disks::disk(meshes::bumps(90, 90));
  const CoarseDisk known = simplify(fine, 1500, Work(1));
  const auto levels = coarser_levels(fine, known, 200, Work(1));
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].fine_vertex, known.fine_vertex);
}

TEST(CoarserLevels, OfADiskThatCannotBeSimplifiedAreNone) {
  // A strip is all bridges.
  const DiskMesh strip = disks::disk(meshes::strip(400));
  EXPECT_TRUE(coarser_levels(strip, std::nullopt, 50, Work(1)).empty());
}

TEST(CoarserLevels, HaveTheSameBitsAtAnyNumberOfThreads) {
  const DiskMesh fine = disks::disk(meshes::bumps(140, 140));
  const auto one = coarser_levels(fine, std::nullopt, 500, Work(1));
  const auto two = coarser_levels(fine, std::nullopt, 500, Work(2));
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t l = 0; l < one.size(); ++l) {
    EXPECT_EQ(one[l].mesh.faces, two[l].mesh.faces);
    EXPECT_EQ(one[l].nearby, two[l].nearby);
  }
}

}  // namespace
}  // namespace beltrami
