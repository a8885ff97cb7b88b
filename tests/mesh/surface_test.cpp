// Adjacency and shape in the large of any oriented manifold.
#include "mesh/surface.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "base/error.h"
#include "mesh/disk_mesh.h"
#include "mesh/split_fans.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

Surface built(const TriangleList& mesh, int threads = 1) {
  return build_surface(mesh.positions, mesh.faces, Work(threads));
}

Topology shape_of(const TriangleList& mesh) {
  return topology_of(built(mesh), Work(1));
}

/// Expects one component with so many handles and boundary loops.
void expect_shape(const TriangleList& mesh, Index genus, Index loops) {
  const Topology topology = shape_of(mesh);
  ASSERT_EQ(topology.components.size(), 1u);
  EXPECT_EQ(topology.components[0].genus(), genus);
  EXPECT_EQ(topology.components[0].loops, loops);
  EXPECT_EQ(topology.components[0].euler(), 2 - 2 * genus - loops);
}

TEST(Surface, KnowsHandlesAndLoops) {
  expect_shape(meshes::tetrahedron(), 0, 0);
  expect_shape(meshes::fan(5), 0, 1);
  expect_shape(meshes::annulus(7), 0, 2);
  expect_shape(meshes::torus(4), 1, 0);
  expect_shape(meshes::torus_with_hole(4), 1, 1);
  expect_shape(meshes::double_torus(4), 2, 0);
}

TEST(Surface, LoopsRunWithTheSurfaceOnTheirLeft) {
  const Surface surface = built(meshes::annulus(7));
  const BoundaryLoops loops = boundary_loops(surface, Work(1));
  ASSERT_EQ(loops.count(), 2);
  std::set<Index> met;
  for (Index loop = 0; loop < 2; ++loop) {
    for (Index i = loops.start[loop]; i < loops.start[loop + 1]; ++i) {
      const Index h = loops.halfedge[i];
      const Index after = i + 1 < loops.start[loop + 1] ? i + 1 : loops.start[loop];
      EXPECT_EQ(surface.twin[h], kNone);
      EXPECT_EQ(surface.target(h), surface.origin(loops.halfedge[after]));
      EXPECT_LE(loops.halfedge[loops.start[loop]], h) << "a loop starts at its least half-edge";
      met.insert(h);
    }
  }
  EXPECT_EQ(met.size(), 14u);
}

TEST(Surface, CountsWhatEachComponentHas) {
  const TriangleList mesh =
      meshes::together({meshes::torus(3), meshes::triangle(), meshes::annulus(5)});
  const Topology topology = shape_of(mesh);
  ASSERT_EQ(topology.components.size(), 3u);
  const Component &torus = topology.components[0], &triangle = topology.components[1],
                  &annulus = topology.components[2];
  EXPECT_EQ(torus.faces, 18);
  EXPECT_EQ(torus.vertices, 9);
  EXPECT_EQ(triangle.first_face, 18);
  EXPECT_TRUE(triangle.is_disk());
  EXPECT_EQ(annulus.boundary_edges, 10);
  EXPECT_FALSE(annulus.is_disk());
  EXPECT_EQ(topology.component_of_loop, (std::vector<Index>{1, 2, 2}));
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    EXPECT_EQ(topology.component_of_face[f], f < 18 ? 0 : f == 18 ? 1 : 2);
  }
}

TEST(Surface, AnUnusedVertexIsInNoComponent) {
  const Surface surface = built(meshes::with_unused_in_front(meshes::torus(3), 2));
  EXPECT_EQ(surface.outgoing[1], kNone);
  EXPECT_EQ(topology_of(surface, Work(1)).components[0].vertices, 9);
}

TEST(Surface, RefusesWhatIsNoOrientedManifold) {
  const auto fault_of = [](const TriangleList& mesh) -> std::optional<Fault> {
    try {
      built(mesh);
    } catch (const Error& error) {
      return error.fault();
    }
    return std::nullopt;
  };
  EXPECT_EQ(fault_of(meshes::three_on_an_edge()), Fault::kNonManifoldEdge);
  EXPECT_EQ(fault_of(meshes::against_each_other()), Fault::kOrientation);
  EXPECT_EQ(fault_of(meshes::bowtie()), Fault::kNonManifoldVertex);
  EXPECT_EQ(fault_of(meshes::moebius(5)), Fault::kOrientation);
  EXPECT_EQ(fault_of({}), Fault::kEmpty);
}

TEST(Surface, IsTheSameAtAnyThreadCount) {
  TriangleList mesh = meshes::together({meshes::torus(120), meshes::grid(150, 100)});
  const std::vector<Index> order = meshes::shuffled(size_of(mesh.faces), 1);
  std::vector<Triangle> faces;
  for (const Index f : order) faces.push_back(mesh.faces[f]);
  mesh.faces = faces;
  const Surface one = built(mesh, 1), two = built(mesh, 2);
  EXPECT_EQ(one.twin, two.twin);
  EXPECT_EQ(one.outgoing, two.outgoing);
  EXPECT_EQ(one.on_boundary, two.on_boundary);
  EXPECT_EQ(connected_faces(one, Work(1)), connected_faces(two, Work(2)));
  EXPECT_EQ(boundary_loops(one, Work(1)).halfedge, boundary_loops(two, Work(2)).halfedge);
}

TEST(ProveDisk, IsWhatADiskIsBuiltBy) {
  const TriangleList mesh = meshes::grid(6, 5);
  const DiskMesh proven = prove_disk(built(mesh), Work(1));
  const DiskMesh disk = build_disk(mesh.positions, mesh.faces, Work(1));
  EXPECT_EQ(proven.boundary, disk.boundary);
  EXPECT_EQ(proven.twin, disk.twin);
}

TEST(SplitFans, GivesEachFanAVertexOfItsOwn) {
  const TriangleList mesh = meshes::bowtie();
  const SplitSurface split =
      split_fans(mesh.positions, mesh.faces, std::vector<Index>(6, kNone), Work(1));
  EXPECT_EQ(split.vertex, (std::vector<Index>{0, 0, 1, 2, 3, 4}));
  EXPECT_EQ(split.surface.faces[0][0], 0);
  EXPECT_EQ(split.surface.faces[1][0], 1);
}

TEST(SplitFans, ClosesASlitOfOneEdge) {
  const TriangleList mesh = meshes::octahedron();
  Surface surface = built(mesh);
  const Index h = 0, other = surface.twin[h];
  surface.twin[h] = surface.twin[other] = kNone;
  const SplitSurface split = split_fans(mesh.positions, mesh.faces, surface.twin, Work(1));
  EXPECT_EQ(split.surface.vertex_count(), 6);
  EXPECT_EQ(split.surface.twin[h], other);
}

TEST(SplitAlong, GivesTheSurfaceThatSplitFansBuilds) {
  for (const TriangleList& mesh : {meshes::torus(8), meshes::grid(6, 5), meshes::octahedron()}) {
    const Surface surface = built(mesh);
    // Slits of one edge, openings and pieces of their own among them.
    for (const Index every : {1, 2, 3, 7, 20}) {
      std::vector<bool> apart(surface.twin.size(), false);
      std::vector<Index> twin = surface.twin;
      for (Index h = 0; h < size_of(twin); ++h) {
        if (surface.edge(h) % every != 0) continue;
        apart[h] = true;
        twin[h] = kNone;
      }
      const SplitSurface one = split_along(surface, apart, Work(1)),
                         other = split_fans(mesh.positions, mesh.faces, twin, Work(1));
      EXPECT_EQ(one.vertex, other.vertex);
      EXPECT_EQ(one.surface.positions, other.surface.positions);
      EXPECT_EQ(one.surface.faces, other.surface.faces);
      EXPECT_EQ(one.surface.twin, other.surface.twin);
      EXPECT_EQ(one.surface.outgoing, other.surface.outgoing);
      EXPECT_EQ(one.surface.on_boundary, other.surface.on_boundary);
    }
  }
}

}  // namespace
}  // namespace beltrami
