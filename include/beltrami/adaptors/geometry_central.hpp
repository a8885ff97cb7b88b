// Meshes of geometry-central.
//
//   const auto surface = beltrami::surface_of(*mesh, geometry->vertexPositions);
//   CornerData<Vector2> uvs = beltrami::corner_uvs_of(*mesh, context.unwrap(surface));
#ifndef BELTRAMI_ADAPTORS_GEOMETRY_CENTRAL_HPP
#define BELTRAMI_ADAPTORS_GEOMETRY_CENTRAL_HPP

#include <geometrycentral/surface/surface_mesh.h>
#include <geometrycentral/utilities/vector2.h>
#include <geometrycentral/utilities/vector3.h>

#include <beltrami/adaptors/polygons.hpp>
#include <beltrami/beltrami.hpp>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

/// The faces of a mesh, in the order of its lists; positions are copied. Vertices count as in
/// getVertexIndices().
inline Surface surface_of(
    geometrycentral::surface::SurfaceMesh& mesh,
    const geometrycentral::surface::VertexData<geometrycentral::Vector3>& positions) {
  auto polygons = std::make_shared<detail::Polygons>();
  auto number = mesh.getVertexIndices();
  for (const auto vertex : mesh.vertices()) {
    const geometrycentral::Vector3& position = positions[vertex];
    polygons->positions.insert(polygons->positions.end(), {position.x, position.y, position.z});
  }
  for (const auto face : mesh.faces()) {
    const std::size_t first = polygons->corners.size();
    for (const auto corner : face.adjacentCorners()) polygons->corner(number[corner.vertex()]);
    polygons->end_face(first);
  }
  const auto& places = polygons->positions;
  return detail::surface_of(places, std::move(polygons));
}

/// One UV per corner. Failure INVALID_ARGUMENT: the mesh has other corners than that of the atlas.
inline Result<geometrycentral::surface::CornerData<geometrycentral::Vector2>> try_corner_uvs_of(
    geometrycentral::surface::SurfaceMesh& mesh, const Atlas& atlas) {
  geometrycentral::surface::CornerData<geometrycentral::Vector2> uvs(mesh);
  Result<void> done = detail::hand_out(atlas.try_corner_uvs(), mesh.nCorners(), [&](auto next) {
    for (const auto face : mesh.faces()) {
      for (const auto corner : face.adjacentCorners()) {
        const Uv uv = next();
        uvs[corner] = {uv[0], uv[1]};
      }
    }
  });
  if (!done) return done.error();
  return uvs;
}

#if BELTRAMI_CPP_EXCEPTIONS
inline geometrycentral::surface::CornerData<geometrycentral::Vector2> corner_uvs_of(
    geometrycentral::surface::SurfaceMesh& mesh, const Atlas& atlas) {
  return try_corner_uvs_of(mesh, atlas).value();
}
#endif

BELTRAMI_CPP_END

#endif  // BELTRAMI_ADAPTORS_GEOMETRY_CENTRAL_HPP
