// Meshes of OpenMesh, of triangles or polygons, with positions of floats or doubles.
//
//   const beltrami::Atlas atlas = context.unwrap(beltrami::surface_of(mesh));
//   beltrami::set_corner_uvs(mesh, atlas);
#ifndef BELTRAMI_ADAPTORS_OPENMESH_HPP
#define BELTRAMI_ADAPTORS_OPENMESH_HPP

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Mesh/ArrayKernel.hh>

#include <beltrami/adaptors/polygons.hpp>
#include <beltrami/beltrami.hpp>

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

BELTRAMI_CPP_BEGIN

template <class Scalar, int N>
struct ItemTraits<OpenMesh::VectorT<Scalar, N>> : ItemOf<Scalar, static_cast<std::size_t>(N)> {};

namespace detail {
template <class Mesh>
using IfOpenMesh = std::enable_if_t<std::is_base_of_v<OpenMesh::ArrayKernel, Mesh>>;

/// Calls `visit` with each half-edge of each face that is not deleted, and `end` after each face.
template <class Mesh, class Visit, class End>
void for_corners_of(const Mesh& mesh, Visit visit, End end) {
  for (const auto face : mesh.faces()) {
    const auto first = mesh.halfedge_handle(face);
    auto edge = first;
    do {
      visit(edge);
      edge = mesh.next_halfedge_handle(edge);
    } while (edge != first);
    end();
  }
}
}  // namespace detail

/// The faces of a mesh that are not deleted, in their order. Positions are read where they are: the
/// mesh must outlive the calls that read the surface. Vertices have the indices of their handles.
template <class Mesh, class = detail::IfOpenMesh<Mesh>>
Surface surface_of(const Mesh& mesh) {
  auto polygons = std::make_shared<detail::Polygons>();
  std::size_t first = 0;
  detail::for_corners_of(
      mesh,
      [&](auto edge) {
        polygons->corner(static_cast<std::size_t>(mesh.to_vertex_handle(edge).idx()));
      },
      [&] {
        polygons->end_face(first);
        first = polygons->corners.size();
      });
  return detail::surface_of(Span<const typename Mesh::Point>(mesh.points(), mesh.n_vertices()),
                            std::move(polygons));
}

/// Writes the UV of each corner to the half-edge that ends there: texcoord2D, which is requested,
/// where OpenMesh's reader of .obj has it, too.
/// Failure INVALID_ARGUMENT: the mesh has other corners than that of the atlas.
template <class Mesh, class = detail::IfOpenMesh<Mesh>>
Result<void> try_set_corner_uvs(Mesh& mesh, const Atlas& atlas) {
  std::size_t corners = 0;
  detail::for_corners_of(
      mesh, [&](auto) { ++corners; }, [] {});
  mesh.request_halfedge_texcoords2D();
  return detail::hand_out(atlas.try_corner_uvs(), corners, [&](auto next) {
    using Number = typename Mesh::TexCoord2D::value_type;
    detail::for_corners_of(
        mesh,
        [&](auto edge) {
          const Uv uv = next();
          mesh.set_texcoord2D(edge, {static_cast<Number>(uv[0]), static_cast<Number>(uv[1])});
        },
        [] {});
  });
}

/// Writes the UV of each vertex: texcoord2D, which is requested. Failure INVALID_ARGUMENT: the mesh
/// has another number of vertices than that of the flattening.
template <class Mesh, class = detail::IfOpenMesh<Mesh>>
Result<void> try_set_vertex_uvs(Mesh& mesh, const Flattening& flattening) {
  mesh.request_vertex_texcoords2D();
  return detail::hand_out(flattening.try_uvs(), mesh.n_vertices(), [&](auto next) {
    using Number = typename Mesh::TexCoord2D::value_type;
    for (std::size_t i = 0; i < mesh.n_vertices(); ++i) {
      const Uv uv = next();
      mesh.set_texcoord2D(mesh.vertex_handle(static_cast<unsigned>(i)),
                          {static_cast<Number>(uv[0]), static_cast<Number>(uv[1])});
    }
  });
}

#if BELTRAMI_CPP_EXCEPTIONS
template <class Mesh, class = detail::IfOpenMesh<Mesh>>
void set_corner_uvs(Mesh& mesh, const Atlas& atlas) {
  try_set_corner_uvs(mesh, atlas).value();
}
template <class Mesh, class = detail::IfOpenMesh<Mesh>>
void set_vertex_uvs(Mesh& mesh, const Flattening& flattening) {
  try_set_vertex_uvs(mesh, flattening).value();
}
#endif

BELTRAMI_CPP_END

#endif  // BELTRAMI_ADAPTORS_OPENMESH_HPP
