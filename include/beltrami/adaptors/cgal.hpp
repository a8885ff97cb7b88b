// CGAL::Surface_mesh, of triangles or polygons, with points of any kernel. That package is under
// the GPL: this header does not include it, the program that has such a mesh does.
//
//   const beltrami::Atlas atlas = context.unwrap(beltrami::surface_of(mesh));
//   auto uvs = mesh.add_property_map<Mesh::Halfedge_index, std::array<double, 2>>("h:uv").first;
//   beltrami::set_corner_uvs(mesh, atlas, uvs);
#ifndef BELTRAMI_ADAPTORS_CGAL_HPP
#define BELTRAMI_ADAPTORS_CGAL_HPP

#include <CGAL/number_utils.h>

#include <beltrami/adaptors/polygons.hpp>
#include <beltrami/beltrami.hpp>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace CGAL {
template <typename Point>
class Surface_mesh;
}

BELTRAMI_CPP_BEGIN

namespace detail {
/// Calls `visit` with each half-edge of each face that is not removed, and `end` after each face.
template <class Point, class Visit, class End>
void for_corners_of(const CGAL::Surface_mesh<Point>& mesh, Visit visit, End end) {
  for (const auto face : mesh.faces()) {
    const auto first = mesh.halfedge(face);
    auto edge = first;
    do {
      visit(edge);
      edge = mesh.next(edge);
    } while (edge != first);
    end();
  }
}
}  // namespace detail

/// The faces of a mesh that are not removed, in their order; positions are copied as doubles.
/// Vertices have the numbers of their indices.
template <class Point>
Surface surface_of(const CGAL::Surface_mesh<Point>& mesh) {
  auto polygons = std::make_shared<detail::Polygons>();
  polygons->positions.resize(3 * static_cast<std::size_t>(mesh.num_vertices()));
  for (const auto vertex : mesh.vertices()) {
    const Point& point = mesh.point(vertex);
    double* position = &polygons->positions[3 * static_cast<std::size_t>(vertex)];
    position[0] = CGAL::to_double(point.x());
    position[1] = CGAL::to_double(point.y());
    position[2] = CGAL::to_double(point.z());
  }
  std::size_t first = 0;
  detail::for_corners_of(
      mesh, [&](auto edge) { polygons->corner(static_cast<std::size_t>(mesh.target(edge))); },
      [&] {
        polygons->end_face(first);
        first = polygons->corners.size();
      });
  const auto& positions = polygons->positions;
  return detail::surface_of(positions, std::move(polygons));
}

/// Writes the UV of each corner to a property of the half-edge that ends there, whose type is made
/// of two doubles: std::array<double, 2>, a Point_2. Failure INVALID_ARGUMENT: the mesh has other
/// corners than that of the atlas.
template <class Point, class Map>
Result<void> try_set_corner_uvs(const CGAL::Surface_mesh<Point>& mesh, const Atlas& atlas,
                                Map uvs) {
  std::size_t corners = 0;
  detail::for_corners_of(
      mesh, [&](auto) { ++corners; }, [] {});
  return detail::hand_out(atlas.try_corner_uvs(), corners, [&](auto next) {
    detail::for_corners_of(
        mesh,
        [&](auto edge) {
          const Uv uv = next();
          uvs[edge] = typename Map::value_type{uv[0], uv[1]};
        },
        [] {});
  });
}

/// Writes the UV of each vertex to a property of such a type. Failure INVALID_ARGUMENT: the mesh
/// has another number of vertices than that of the flattening.
template <class Point, class Map>
Result<void> try_set_vertex_uvs(const CGAL::Surface_mesh<Point>& mesh, const Flattening& flattening,
                                Map uvs) {
  const Result<std::vector<Uv>> found = flattening.try_uvs();
  if (!found) return found.error();
  if (found->size() != static_cast<std::size_t>(mesh.num_vertices())) {
    return Failure(Status::kInvalidArgument, "the result is that of a mesh of another size");
  }
  for (const auto vertex : mesh.vertices()) {
    const Uv& uv = (*found)[static_cast<std::size_t>(vertex)];
    uvs[vertex] = typename Map::value_type{uv[0], uv[1]};
  }
  return {};
}

#if BELTRAMI_CPP_EXCEPTIONS
template <class Point, class Map>
void set_corner_uvs(const CGAL::Surface_mesh<Point>& mesh, const Atlas& atlas, Map uvs) {
  try_set_corner_uvs(mesh, atlas, uvs).value();
}
template <class Point, class Map>
void set_vertex_uvs(const CGAL::Surface_mesh<Point>& mesh, const Flattening& flattening, Map uvs) {
  try_set_vertex_uvs(mesh, flattening, uvs).value();
}
#endif

BELTRAMI_CPP_END

#endif  // BELTRAMI_ADAPTORS_CGAL_HPP
