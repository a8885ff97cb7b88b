// Holes closed with virtual faces: manifold, in the right place, and only where they are small.
#include "admit/fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami {
namespace {

using meshes::TriangleList;

FilledSurface filled(const TriangleList& mesh, double limit = 0.5) {
  const Work work(1);
  Surface surface = build_surface(mesh.positions, mesh.faces, work);
  const Topology topology = topology_of(surface, work);
  return fill_holes(std::move(surface), topology, limit, work);
}

/// Built anew from its faces, the surface is the same: what fill_holes kept by hand is right.
void expect_sound(const FilledSurface& filled) {
  const Work work(1);
  const Surface& surface = filled.surface;
  const Surface anew = build_surface(surface.positions, surface.faces, work);
  EXPECT_EQ(anew.twin, surface.twin);
  EXPECT_EQ(anew.on_boundary, surface.on_boundary);
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    Index count = 0;
    surface.for_each_outgoing(v, [&](Index h) {
      EXPECT_EQ(surface.origin(h), v);
      ++count;
    });
    EXPECT_GE(count, 1);
  }
}

/// A grid without the faces around one inner vertex, and without one face elsewhere.
TriangleList sheet_with_holes() {
  TriangleList mesh = meshes::grid(12, 12);
  const Index centre = 13 * 4 + 4;
  mesh.faces.erase(mesh.faces.begin() + 200);
  std::erase_if(mesh.faces, [&](const Triangle& face) {
    return std::find(face.begin(), face.end(), centre) != face.end();
  });
  mesh.positions[centre] = Vec3::Zero();
  return mesh;
}

TEST(FillHoles, ClosesATorusWithAFace) {
  const FilledSurface result = filled(meshes::torus_with_hole(8), 1);
  expect_sound(result);
  EXPECT_EQ(result.filled_loops, 1);
  EXPECT_EQ(result.surface.face_count(), result.real_faces + 1);
  EXPECT_EQ(result.surface.vertex_count(), result.real_vertices);
  const Topology topology = topology_of(result.surface, Work(1));
  EXPECT_EQ(topology.loops.count(), 0);
  EXPECT_EQ(topology.components[0].genus(), 1);
}

TEST(FillHoles, LeavesTheLongBoundaryOpen) {
  const TriangleList mesh = sheet_with_holes();
  TriangleList used{{}, mesh.faces};
  for (const Index v : drop_unreferenced(size_of(mesh.positions), used.faces, Work(1))) {
    used.positions.push_back(mesh.positions[v]);
  }
  const FilledSurface result = filled(used);
  expect_sound(result);
  EXPECT_EQ(result.filled_loops, 1) << "the hole of one face; the other is longer";
  const FilledSurface all = filled(used, 1);
  expect_sound(all);
  EXPECT_EQ(all.filled_loops, 2);
  EXPECT_EQ(all.surface.face_count() - all.real_faces, 1 + 6);
  EXPECT_TRUE(topology_of(all.surface, Work(1)).components[0].is_disk());
}

TEST(FillHoles, LeavesADiskAsItIs) {
  for (const TriangleList& mesh : {meshes::grid(5, 4), meshes::triangle()}) {
    const FilledSurface result = filled(mesh, 1e9);
    EXPECT_EQ(result.filled_loops, 0);
    EXPECT_EQ(result.surface.face_count(), size_of(mesh.faces));
  }
}

TEST(FillHoles, NeverClosesTheLongestBoundary) {
  // A flat ring, and a tube of equal ends.
  TriangleList tube = meshes::annulus(12);
  for (Vec3& p : tube.positions) {
    const double radius = std::sqrt(p.squaredNorm());
    p = {p.x() / radius, p.y() / radius, radius};
  }
  for (const TriangleList& mesh : {meshes::annulus(12), tube}) {
    const FilledSurface result = filled(mesh, 1e9);
    expect_sound(result);
    EXPECT_EQ(result.filled_loops, 1);
    EXPECT_TRUE(topology_of(result.surface, Work(1)).components[0].is_disk());
  }
  // Two bands of a torus that cross: with a handle, and one boundary, which is long.
  TriangleList bands{meshes::torus(8).positions, {}};
  for (Index cell = 0; cell < 64; ++cell) {
    if (cell % 8 != 0 && cell / 8 != 0) continue;
    for (const Index f : {2 * cell, 2 * cell + 1}) bands.faces.push_back(meshes::torus(8).faces[f]);
  }
  EXPECT_EQ(filled(bands, 1e9).filled_loops, 0);
}

TEST(FillHoles, FillsTheShorterBoundaryOfAFlatRing) {
  const TriangleList mesh = meshes::annulus(12);
  const FilledSurface result = filled(mesh, 1e9);
  const Topology topology = topology_of(result.surface, Work(1));
  ASSERT_EQ(topology.loops.count(), 1);
  double farthest = 0, nearest = 1e9;
  for (const Vec3& p : mesh.positions) farthest = std::max(farthest, p.norm());
  for (const Index h : topology.loops.halfedge) {
    nearest = std::min(nearest, result.surface.positions[result.surface.origin(h)].norm());
  }
  EXPECT_NEAR(nearest, farthest, 1e-12) << "the outer one is left";
}

TEST(FillHoles, LeavesALoopWithoutAreaOpen) {
  // An annulus whose inner boundary lies on a line.
  const TriangleList mesh{
      {{-3, -3, 0},
       {3, -3, 0},
       {3, 3, 0},
       {-3, 3, 0},
       {-1, 0, 0},
       {0, 0, 0},
       {1, 0, 0},
       {0.5, 0, 0}},
      {{0, 1, 5}, {1, 6, 5}, {1, 2, 6}, {2, 7, 6}, {2, 3, 7}, {3, 4, 7}, {3, 0, 4}, {0, 5, 4}}};
  EXPECT_EQ(filled(mesh, 1e9).filled_loops, 0);
}

}  // namespace
}  // namespace beltrami
