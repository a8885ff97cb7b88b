// Where sheets meet, those that continue each other stay whole.
#include "admit/continue_sheets.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numbers>
#include <set>
#include <vector>

#include "admit/admit.h"
#include "base/portable_math.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/surface.h"
#include "support/meshes.h"
#include "support/solids.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;
/// Sets of two faces of the input.
using Pairs = std::set<std::set<Index>>;

Admitted admitted(const TriangleList& mesh) {
  return admit(mesh.positions, mesh.faces, {}, Work(1));
}

/// The faces that are glued to each other; `number` is what a face is called.
Pairs glued(const Admitted& result, const std::vector<Index>& number) {
  Pairs pairs;
  const Surface& surface = result.surface;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (surface.twin[h] == kNone) continue;
    pairs.insert(
        {number[result.input_face[h / 3]], number[result.input_face[surface.twin[h] / 3]]});
  }
  return pairs;
}

Pairs glued(const TriangleList& mesh) {
  std::vector<Index> number(mesh.faces.size());
  for (Index f = 0; f < size_of(number); ++f) number[f] = f;
  return glued(admitted(mesh), number);
}

/// Faces on one edge, each at one of `angles` in degrees. All run the same way along it, but those
/// that are `turned`.
TriangleList leaves(const std::vector<double>& angles, const std::vector<bool>& turned = {}) {
  TriangleList mesh{{{0, 0, 0}, {0, 0, 1}}, {}};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double angle = std::numbers::pi / 180 * angles[i];
    mesh.positions.push_back({portable::cos(angle), portable::sin(angle), 0.3});
    const Index leaf = static_cast<Index>(i) + 2;
    const bool is_turned = !turned.empty() && turned[i];
    mesh.faces.push_back(is_turned ? Triangle{1, 0, leaf} : Triangle{0, 1, leaf});
  }
  return mesh;
}

/// The same mesh with vertices and faces in another order, and faces that begin elsewhere; `order`
/// gets what each face was.
TriangleList renumbered(const TriangleList& mesh, std::uint64_t seed, std::vector<Index>& order) {
  const std::vector<Index> vertex = meshes::shuffled(size_of(mesh.positions), 2 * seed + 1);
  order = meshes::shuffled(size_of(mesh.faces), 2 * seed);
  TriangleList other = mesh;
  for (std::size_t v = 0; v < vertex.size(); ++v) other.positions[vertex[v]] = mesh.positions[v];
  for (std::size_t f = 0; f < order.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      other.faces[f][k] = vertex[mesh.faces[order[f]][(k + f) % 3]];
    }
  }
  return other;
}

TEST(ContinueSheets, ASheetGoesOnWhereAnotherMeetsIt) {
  const TriangleList mesh = meshes::three_on_an_edge();
  EXPECT_EQ(glued(mesh), (Pairs{{0, 1}}));
  EXPECT_EQ(admitted(mesh).counts.components, 2);
  EXPECT_EQ(admitted(mesh).counts.crowded_edges, 1);
}

TEST(ContinueSheets, TheFlattestPairComesFirstWhicheverWayFacesRun) {
  for (int ways = 0; ways < 8; ++ways) {
    const std::vector<bool> turned = {(ways & 1) != 0, (ways & 2) != 0, (ways & 4) != 0};
    EXPECT_EQ(glued(leaves({0, 90, 170}, turned)), (Pairs{{0, 2}})) << ways;
  }
  EXPECT_EQ(glued(leaves({0, 60, 120, 180, 240, 300})), (Pairs{{0, 3}, {1, 4}, {2, 5}}));
  EXPECT_EQ(glued(leaves({0, 100, 180, 200, 275})), (Pairs{{0, 2}, {1, 4}}));
}

TEST(ContinueSheets, OfPairsThatBendAlikeThoseAreJoinedThatRunAgainstEachOther) {
  // A sheet with two sides that lie a tenth of a degree apart, and a wall on it.
  EXPECT_EQ(glued(leaves({0, 0.1, 180.1, 180, 90}, {false, true, true, false, false})),
            (Pairs{{0, 2}, {1, 3}}));
  EXPECT_EQ(glued(leaves({0, 0.1, 180.1, 180, 90}, {false, true, false, true, false})),
            (Pairs{{0, 3}, {1, 2}}));
}

TEST(ContinueSheets, ManyFacesOfAnEdgePart) {
  std::vector<double> angles;
  for (int i = 0; i < 40; ++i) angles.push_back(9 * i);
  EXPECT_TRUE(glued(leaves(angles)).empty());
}

TEST(ContinueSheets, KnowsAnglesAtAnyScaleAndInNeedles) {
  for (const double scale : {1e-310, 1e-160, 1e160, 1e300}) {
    TriangleList mesh = leaves({0, 90, 170});
    for (Vec3& p : mesh.positions) p *= scale;
    EXPECT_EQ(glued(mesh), (Pairs{{0, 2}})) << scale;
  }
  TriangleList mesh = leaves({0, 90, 170});
  for (Vec3& p : mesh.positions) p.z() = p.z() * 1e5 + 3e5;
  EXPECT_EQ(glued(mesh), (Pairs{{0, 2}}));
}

TEST(ContinueSheets, SheetsThatCrossAreTwoDisksHoweverTheyAreNumbered) {
  // 4 x 4 cells each, with the line in their middle in common.
  TriangleList mesh = meshes::together({meshes::grid(4, 4), meshes::grid(4, 4)});
  for (Index v = 0; v < size_of(mesh.positions); ++v) {
    Vec3& p = mesh.positions[v];
    if (v >= 25) p = {0.5 + (p.x() - 0.5) * 0.28, p.y(), (p.x() - 0.5) * 0.96};
    p = meshes::some_turn() * p;
  }
  const Pairs expected = glued(mesh);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<Index> order;
    const Admitted result = admitted(renumbered(mesh, seed, order));
    EXPECT_EQ(glued(result, order), expected);
    EXPECT_EQ(result.counts.crowded_edges, 4);
    EXPECT_EQ(result.counts.components, 2);
    for (const Component& component : result.topology.components) EXPECT_TRUE(component.is_disk());
  }
}

TEST(ContinueSheets, SolidsThatTouchAlongEdgesComeApart) {
  // Four edges long, turned so that no angle is exact.
  TriangleList mesh = meshes::split_in_four(meshes::cube(), 2);
  const TriangleList one = mesh;
  mesh = meshes::together({one, one});
  for (Index v = 0; v < size_of(mesh.positions); ++v) {
    Vec3& p = mesh.positions[v];
    if (v >= size_of(one.positions)) p += Vec3(1, 1, 0);
    p = meshes::some_turn() * p;
    for (double& x : p) x = static_cast<float>(x);
  }
  const Admitted result = admitted(mesh);
  EXPECT_EQ(result.counts.crowded_edges, 4);
  EXPECT_EQ(result.counts.components, 2);
  EXPECT_EQ(result.counts.closed_components, 2);
  EXPECT_EQ(result.counts.reversed_faces, 0);
}

TEST(ContinueSheets, ARoomDividedByAWallIsAShellAndAWall) {
  // Two boxes with a face in common, of which there is one copy.
  TriangleList mesh = meshes::together({meshes::cube(), meshes::cube()});
  for (Index v = 8; v < 16; ++v) mesh.positions[v] += Vec3(1, 0, 0);
  const auto lies_between = [&](const Triangle& face) {
    return mesh.positions[face[0]].x() == 1 && mesh.positions[face[1]].x() == 1 &&
           mesh.positions[face[2]].x() == 1;
  };
  for (std::size_t f = mesh.faces.size() - 1; f >= 12; --f) {
    if (lies_between(mesh.faces[f])) {
      mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(f));
    }
  }
  const Admitted result = admitted(mesh);
  EXPECT_EQ(result.counts.crowded_edges, 4);
  EXPECT_EQ(result.counts.components, 2);
  EXPECT_EQ(result.counts.closed_components, 1) << "the shell";
}

TEST(ContinueSheets, NothingIsGluedThatWouldMakeAPieceOneSided) {
  // A band with a twist, and a wall on one of its rungs: there it opens, and not elsewhere.
  TriangleList mesh = meshes::moebius(9);
  mesh.positions.push_back(mesh.positions[0] + Vec3(0, 0, 1));
  mesh.faces.push_back({0, 1, size_of(mesh.positions) - 1});
  const Admitted result = admitted(mesh);
  EXPECT_EQ(result.counts.one_sided_edges, 0);
  ASSERT_EQ(result.counts.components, 1) << "the wall goes on where the band does not";
  EXPECT_TRUE(result.topology.components[0].is_disk());
}

}  // namespace
}  // namespace beltrami
