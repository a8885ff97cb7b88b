// The first levels of large surfaces.
#include "simplify/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "support/cuts.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

std::vector<TriangleList> surfaces() {
  TriangleList perforated = disks::blob(4);
  for (const Index f : {1500, 900, 300}) perforated.faces.erase(perforated.faces.begin() + f);
  return {disks::blob(5),           meshes::torus(40),
          meshes::double_torus(30), perforated,
          meshes::bumps(40, 40),    meshes::together({meshes::torus(24), disks::blob(3)})};
}

Surface surface_of(const TriangleList& mesh) {
  return build_surface(mesh.positions, mesh.faces, Work(1));
}

TEST(SweepSurface, KeepsTheTopologyAndTheWholeBoundary) {
  for (const TriangleList& mesh : surfaces()) {
    const Surface fine = surface_of(mesh);
    const CoarseSurface coarse = sweep_surface(fine, fine.face_count() / 8, Work(1));
    EXPECT_LT(coarse.mesh.face_count(), fine.face_count() / 3);
    const Topology before = topology_of(fine, Work(1)), after = topology_of(coarse.mesh, Work(1));
    ASSERT_EQ(before.components.size(), after.components.size());
    for (std::size_t c = 0; c < before.components.size(); ++c) {
      EXPECT_EQ(before.components[c].euler(), after.components[c].euler());
      EXPECT_EQ(before.components[c].boundary_edges, after.components[c].boundary_edges);
    }
    for (Index v = 0; v < coarse.mesh.vertex_count(); ++v) {
      EXPECT_EQ(coarse.mesh.positions[v], fine.positions[coarse.fine_vertex[v]]);
    }
    const auto used = std::count_if(fine.outgoing.begin(), fine.outgoing.end(),
                                    [](Index h) { return h != kNone; });
    EXPECT_EQ(std::ssize(coarse.history.steps) + std::ssize(coarse.fine_vertex), used);
  }
}

TEST(SweepSurface, LeavesTheAdjacencyThatIsBuiltAnew) {
  for (const TriangleList& mesh : surfaces()) {
    const Surface fine = surface_of(mesh);
    const Surface left = sweep_surface(fine, fine.face_count() / 5, Work(1)).mesh;
    const Surface anew = build_surface(left.positions, left.faces, Work(1));
    EXPECT_EQ(left.twin, anew.twin);
    EXPECT_EQ(left.on_boundary, anew.on_boundary);
    for (Index v = 0; v < left.vertex_count(); ++v) {
      EXPECT_EQ(left.origin(left.outgoing[v]), v);
      EXPECT_TRUE(!left.on_boundary[v] || left.outgoing[v] == anew.outgoing[v]);
    }
  }
}

TEST(SweepSurface, GivesTheSameBitsOnAnyNumberOfThreads) {
  const Surface fine = surface_of(meshes::torus(250));  // several blocks of vertices
  const CoarseSurface one = sweep_surface(fine, 10'000, Work(1)),
                      two = sweep_surface(fine, 10'000, Work(2));
  EXPECT_EQ(one.mesh.faces, two.mesh.faces);
  EXPECT_EQ(one.fine_vertex, two.fine_vertex);
  EXPECT_EQ(one.fine_face, two.fine_face);
  EXPECT_EQ(one.history.renamed, two.history.renamed);
}

TEST(SweepSurface, StaysNearTheSurface) {
  const Surface fine = surface_of(disks::blob(6));
  const Surface coarse = sweep_surface(fine, fine.face_count() / 8, Work(1)).mesh;
  EXPECT_NEAR(surface_area(coarse, Work(1)), surface_area(fine, Work(1)),
              0.01 * surface_area(fine, Work(1)));
}

TEST(SweepSurface, LeavesHubsAlone) {
  const Surface fine = surface_of(meshes::fan(500));
  EXPECT_EQ(sweep_surface(fine, 10, Work(1)).mesh.faces, fine.faces);
}

}  // namespace
}  // namespace beltrami
