// Cuts that come with the input.
#include "cut/given.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>
#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Index marked_edges(const TriangleList& mesh, const GivenCuts& cuts) {
  const Work work(1);
  const Admitted admitted = admit(mesh.positions, mesh.faces, {}, work);
  const EdgeMarks marks = given_marks(admitted, cuts, work);
  Index count = 0;
  for (Index h = 0; h < size_of(admitted.surface.twin); ++h) {
    const Index twin = admitted.surface.twin[h];
    EXPECT_TRUE(twin == kNone || marks[h] == marks[twin]);
    count += marks[h] && (twin == kNone || h < twin) ? 1 : 0;
  }
  return count;
}

TEST(GivenMarks, NothingWhereNothingIsGiven) {
  EXPECT_TRUE(GivenCuts().none());
  EXPECT_EQ(marked_edges(meshes::cube(), {}), 0);
}

TEST(GivenMarks, HardEdgesOfACubeAreItsTwelve) {
  GivenCuts cuts;
  cuts.hard_angle = std::numbers::pi / 4;
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 12);
  cuts.hard_angle = 0.6 * std::numbers::pi;
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 0);
}

/// A sheet with a ridge along its middle line, from `from` to `to`.
TriangleList ridge(double from, double to) {
  TriangleList mesh = meshes::grid(8, 8);
  for (Vec3& p : mesh.positions) {
    if (p.y() == 0.5 && p.x() >= from && p.x() <= to) p.z() = 0.1;
  }
  return mesh;
}

TEST(GivenMarks, CreasesThatEndWithinTheSurfaceAreNone) {
  GivenCuts cuts;
  cuts.hard_angle = std::numbers::pi / 3;
  EXPECT_EQ(marked_edges(ridge(0, 1), cuts), 8);
  EXPECT_EQ(marked_edges(ridge(0, 0.5), cuts), 4) << "one that comes from the border is";
  const TriangleList inside = ridge(0.25, 0.75);
  EXPECT_EQ(marked_edges(inside, cuts), 0);
  const auto at = [&](double x) {
    for (Index v = 0; v < size_of(inside.positions); ++v) {
      if (inside.positions[v] == Vec3(x, 0.5, 0.1)) return v;
    }
    return kNone;
  };
  cuts.edges = {{at(0.375), at(0.5)}};
  EXPECT_EQ(marked_edges(inside, cuts), 4) << "nor where an edge of it is asked for";
}

TEST(GivenMarks, EdgesByTheirEndsInEitherDirectionAndWelded) {
  GivenCuts cuts;
  cuts.edges = {{0, 2}, {3, 2}, {0, 7}, {5, 5}};
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 2) << "0-7 and 5-5 are no edges";
  // The same edges of a soup, by the corners of any of its faces.
  const TriangleList apart = meshes::soup(meshes::cube());
  cuts.edges = {{0, 1}, {2, 1}};
  EXPECT_EQ(marked_edges(apart, cuts), 2);
}

TEST(GivenMarks, LabelsPartWhereTheyDiffer) {
  GivenCuts cuts;
  for (Index f = 0; f < 12; ++f) cuts.labels.push_back(f / 2);
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 12);
  cuts.labels.assign(12, 7);
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 0);
  cuts.labels[0] = cuts.labels[1] = 1;
  EXPECT_EQ(marked_edges(meshes::cube(), cuts), 4);
}

TEST(GivenMarks, IslandsPartWhereUvsDifferAtEitherEnd) {
  const TriangleList mesh = meshes::grid(2, 1);
  GivenCuts cuts;
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) {
      cuts.corner_uvs.emplace_back(mesh.positions[v].x(), mesh.positions[v].y());
    }
  }
  EXPECT_EQ(marked_edges(mesh, cuts), 0);
  for (Vec2& uv : cuts.corner_uvs) {
    if (uv.x() == 0) uv.x() = -0.0;
  }
  EXPECT_EQ(marked_edges(mesh, cuts), 0) << "the sign of zero is no difference";
  // One corner of the second square moves: the edges at it part, the one across stays.
  cuts.corner_uvs[3 * 2] += Vec2(0.25, 0);
  EXPECT_GE(marked_edges(mesh, cuts), 1);
}

TEST(GivenMarks, IslandsFollowFacesThatWereTurnedOver) {
  TriangleList mesh = meshes::grid(3, 1);
  GivenCuts cuts;
  std::swap(mesh.faces[2][1], mesh.faces[2][2]);
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) {
      cuts.corner_uvs.emplace_back(mesh.positions[v].x(), mesh.positions[v].y());
    }
  }
  EXPECT_EQ(marked_edges(mesh, cuts), 0);
}

}  // namespace
}  // namespace beltrami
