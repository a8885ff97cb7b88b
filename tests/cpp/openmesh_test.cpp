// Meshes of OpenMesh: the same surface as their arrays, and UVs at the half-edges of its corners.
#include <gtest/gtest.h>
#include <beltrami/adaptors/openmesh.hpp>
#include <beltrami/beltrami.hpp>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <cstddef>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using TexCoord2D = OpenMesh::Vec2d;
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using FloatMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;

template <class Mesh>
Mesh mesh_of(const Polygons& polygons) {
  Mesh mesh;
  using Number = typename Mesh::Scalar;
  for (const Position& p : polygons.positions) {
    mesh.add_vertex(
        {static_cast<Number>(p[0]), static_cast<Number>(p[1]), static_cast<Number>(p[2])});
  }
  std::size_t at = 0;
  for (const std::uint32_t size : polygons.sizes) {
    std::vector<typename Mesh::VertexHandle> face;
    for (std::uint32_t k = 0; k < size; ++k, ++at) {
      face.push_back(mesh.vertex_handle(polygons.corners[at]));
    }
    mesh.add_face(face);
  }
  return mesh;
}

Polygons polygons_of(const Triangles& mesh) {
  Polygons polygons{mesh.positions, {}, std::vector<std::uint32_t>(mesh.faces.size(), 3)};
  for (const Face& face : mesh.faces) {
    polygons.corners.insert(polygons.corners.end(), face.begin(), face.end());
  }
  return polygons;
}

/// What a texture coordinate at a half-edge is for: the corner where it ends.
template <class Mesh>
void expect_uvs_at_corners(const Mesh& mesh, const Atlas& atlas) {
  const std::vector<Uv> split = atlas.uv_vertices();
  const auto index = atlas.corner_uv_vertices();
  const auto origin = atlas.uv_vertex_origins();
  std::size_t corner = 0;
  for (const auto face : mesh.faces()) {
    for (const auto edge : mesh.fh_range(face)) {
      const std::uint32_t uv_vertex = index[corner++];
      EXPECT_EQ(static_cast<int>(origin[uv_vertex]), mesh.to_vertex_handle(edge).idx());
      EXPECT_EQ(mesh.texcoord2D(edge)[0], split[uv_vertex][0]);
      EXPECT_EQ(mesh.texcoord2D(edge)[1], split[uv_vertex][1]);
    }
  }
  EXPECT_EQ(corner, index.size());
}

TEST(CppOpenMesh, TrianglesAndPolygonsGetUvsAtTheirCorners) {
  auto triangles = mesh_of<TriMesh>(polygons_of(triangulated_cube()));
  const Atlas atlas = Context().unwrap(surface_of(triangles));
  EXPECT_EQ(atlas.info().faces, 12u);
  set_corner_uvs(triangles, atlas);
  expect_uvs_at_corners(triangles, atlas);

  auto squares = mesh_of<PolyMesh>(cube());
  const Atlas of_squares = Context().unwrap(surface_of(squares));
  EXPECT_EQ(of_squares.info().faces, 6u);
  EXPECT_EQ(of_squares.info().corners, 24u);
  set_corner_uvs(squares, of_squares);
  expect_uvs_at_corners(squares, of_squares);
}

TEST(CppOpenMesh, ADiskGetsUvsAtItsVertices) {
  const Triangles plain = hump(6);
  auto mesh = mesh_of<TriMesh>(polygons_of(plain));
  const Flattening flat = Context().flatten(surface_of(mesh));
  set_vertex_uvs(mesh, flat);
  const std::vector<Uv> uvs = flat.uvs();
  for (const auto vertex : mesh.vertices()) {
    EXPECT_EQ(mesh.texcoord2D(vertex)[0], uvs[static_cast<std::size_t>(vertex.idx())][0]);
  }
  EXPECT_EQ(flat.info().vertices, plain.positions.size());

  auto floats = mesh_of<FloatMesh>(polygons_of(plain));
  set_vertex_uvs(floats, Context().flatten(surface_of(floats)));
  EXPECT_NE(floats.texcoord2D(floats.vertex_handle(0)), floats.texcoord2D(floats.vertex_handle(1)));
}

TEST(CppOpenMesh, DeletedFacesAreNone) {
  auto mesh = mesh_of<TriMesh>(polygons_of(triangulated_cube()));
  mesh.request_face_status();
  mesh.request_edge_status();
  mesh.request_vertex_status();
  mesh.request_halfedge_status();
  mesh.delete_face(mesh.face_handle(3), false);
  const Atlas atlas = Context().unwrap(surface_of(mesh));
  EXPECT_EQ(atlas.info().faces, 11u);
  set_corner_uvs(mesh, atlas);
  expect_uvs_at_corners(mesh, atlas);
}

TEST(CppOpenMesh, ResultsOfAnotherMeshAreRefused) {
  auto mesh = mesh_of<TriMesh>(polygons_of(triangulated_cube()));
  const Triangles quad = bent_quad();
  Context context;
  const Surface other(quad.positions, quad.faces);
  EXPECT_EQ(try_set_corner_uvs(mesh, context.unwrap(other)).status(), Status::kInvalidArgument);
  EXPECT_EQ(try_set_vertex_uvs(mesh, context.flatten(other)).status(), Status::kInvalidArgument);
}

}  // namespace
}  // namespace beltrami::host
