// CGAL::Surface_mesh: the same surface as its arrays, and UVs at the half-edges of its corners.
#include <gtest/gtest.h>
#include <beltrami/adaptors/cgal.hpp>
#include <beltrami/beltrami.hpp>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <array>
#include <cstddef>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Halfedge = Mesh::Halfedge_index;
using Vertex = Mesh::Vertex_index;

Mesh mesh_of(const Polygons& polygons) {
  Mesh mesh;
  for (const Position& p : polygons.positions) mesh.add_vertex({p[0], p[1], p[2]});
  std::size_t at = 0;
  for (const std::uint32_t size : polygons.sizes) {
    std::vector<Vertex> face;
    for (std::uint32_t k = 0; k < size; ++k) face.emplace_back(polygons.corners[at++]);
    mesh.add_face(face);
  }
  return mesh;
}

template <class Map>
void expect_uvs_at_corners(const Mesh& mesh, const Atlas& atlas, const Map& uvs) {
  const std::vector<Uv> split = atlas.uv_vertices();
  const auto index = atlas.corner_uv_vertices();
  const auto origin = atlas.uv_vertex_origins();
  std::size_t corner = 0;
  for (const auto face : mesh.faces()) {
    for (const Halfedge edge : mesh.halfedges_around_face(mesh.halfedge(face))) {
      const std::uint32_t uv_vertex = index[corner++];
      EXPECT_EQ(Vertex(origin[uv_vertex]), mesh.target(edge));
      EXPECT_EQ(uvs[edge][0], split[uv_vertex][0]);
      EXPECT_EQ(uvs[edge][1], split[uv_vertex][1]);
    }
  }
  EXPECT_EQ(corner, index.size());
}

TEST(CppCgal, PolygonsGetUvsAtTheirCorners) {
  Mesh mesh = mesh_of(cube());
  const Atlas atlas = Context().unwrap(surface_of(mesh));
  EXPECT_EQ(atlas.info().faces, 6u);
  auto arrays = mesh.add_property_map<Halfedge, std::array<double, 2>>("h:uv").first;
  set_corner_uvs(mesh, atlas, arrays);
  expect_uvs_at_corners(mesh, atlas, arrays);
  auto points = mesh.add_property_map<Halfedge, Kernel::Point_2>("h:point").first;
  set_corner_uvs(mesh, atlas, points);
  expect_uvs_at_corners(mesh, atlas, points);
}

TEST(CppCgal, ADiskGetsUvsAtItsVertices) {
  const Triangles plain = hump(6);
  Polygons polygons{plain.positions, {}, std::vector<std::uint32_t>(plain.faces.size(), 3)};
  for (const Face& face : plain.faces) {
    polygons.corners.insert(polygons.corners.end(), face.begin(), face.end());
  }
  Mesh mesh = mesh_of(polygons);
  const Flattening flat = Context().flatten(surface_of(mesh));
  auto uvs = mesh.add_property_map<Vertex, Uv>("v:uv").first;
  set_vertex_uvs(mesh, flat, uvs);
  const std::vector<Uv> expected = flat.uvs();
  for (const Vertex vertex : mesh.vertices()) EXPECT_EQ(uvs[vertex], expected[vertex]);
}

TEST(CppCgal, RemovedElementsAreNone) {
  Mesh mesh = mesh_of(cube());
  const Vertex lone = mesh.add_vertex({9, 9, 9});
  mesh.remove_vertex(lone);
  CGAL::Euler::remove_face(mesh.halfedge(Mesh::Face_index(2)), mesh);
  const Atlas atlas = Context().unwrap(surface_of(mesh));
  EXPECT_EQ(atlas.info().faces, 5u);
  EXPECT_EQ(atlas.info().vertices, 9u);
  auto uvs = mesh.add_property_map<Halfedge, Uv>("h:uv").first;
  set_corner_uvs(mesh, atlas, uvs);
  expect_uvs_at_corners(mesh, atlas, uvs);
}

TEST(CppCgal, ResultsOfAnotherMeshAreRefused) {
  Mesh mesh = mesh_of(cube());
  const Triangles quad = bent_quad();
  Context context;
  const Surface other(quad.positions, quad.faces);
  auto corners = mesh.add_property_map<Halfedge, Uv>("h:uv").first;
  auto vertices = mesh.add_property_map<Vertex, Uv>("v:uv").first;
  EXPECT_EQ(try_set_corner_uvs(mesh, context.unwrap(other), corners).status(),
            Status::kInvalidArgument);
  EXPECT_EQ(try_set_vertex_uvs(mesh, context.flatten(other), vertices).status(),
            Status::kInvalidArgument);
}

}  // namespace
}  // namespace beltrami::host
