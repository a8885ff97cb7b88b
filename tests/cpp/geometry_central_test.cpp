// Meshes of geometry-central: the same surface as their lists, and UVs at their corners.
#include <geometrycentral/surface/surface_mesh.h>
#include <gtest/gtest.h>
#include <beltrami/adaptors/geometry_central.hpp>
#include <beltrami/beltrami.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

namespace gc = geometrycentral;
using gc::surface::SurfaceMesh;

/// A mesh and its positions.
struct OfLists {
  explicit OfLists(const Polygons& polygons) : mesh(faces_of(polygons)), positions(mesh) {
    for (std::size_t i = 0; i < polygons.positions.size(); ++i) {
      const Position& p = polygons.positions[i];
      positions[mesh.vertex(i)] = {p[0], p[1], p[2]};
    }
  }

  static std::vector<std::vector<std::size_t>> faces_of(const Polygons& polygons) {
    std::vector<std::vector<std::size_t>> faces;
    auto at = polygons.corners.begin();
    for (const std::uint32_t size : polygons.sizes) {
      faces.emplace_back(at, at + size);
      at += size;
    }
    return faces;
  }

  SurfaceMesh mesh;
  gc::surface::VertexData<gc::Vector3> positions;
};

TEST(CppGeometryCentral, PolygonsGetUvsAtTheirCorners) {
  OfLists cube_of_lists(cube());
  SurfaceMesh& mesh = cube_of_lists.mesh;
  const Atlas atlas = Context().unwrap(surface_of(mesh, cube_of_lists.positions));
  EXPECT_EQ(atlas.info().faces, 6u);
  const gc::surface::CornerData<gc::Vector2> uvs = corner_uvs_of(mesh, atlas);
  const std::vector<Uv> split = atlas.uv_vertices();
  const auto index = atlas.corner_uv_vertices();
  const auto origin = atlas.uv_vertex_origins();
  std::size_t corner = 0;
  for (const auto face : mesh.faces()) {
    for (const auto at : face.adjacentCorners()) {
      const std::uint32_t uv_vertex = index[corner++];
      EXPECT_EQ(origin[uv_vertex], at.vertex().getIndex());
      EXPECT_EQ(uvs[at].x, split[uv_vertex][0]);
      EXPECT_EQ(uvs[at].y, split[uv_vertex][1]);
    }
  }
  EXPECT_EQ(corner, index.size());
}

TEST(CppGeometryCentral, ResultsOfAnotherMeshAreRefused) {
  OfLists cube_of_lists(cube());
  const Triangles quad = bent_quad();
  const Atlas other = Context().unwrap(Surface(quad.positions, quad.faces));
  EXPECT_EQ(try_corner_uvs_of(cube_of_lists.mesh, other).status(), Status::kInvalidArgument);
}

}  // namespace
}  // namespace beltrami::host
