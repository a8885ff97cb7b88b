#include "files/triangulate.h"

#include <beltrami/beltrami.h>

#include <algorithm>
#include <new>
#include <string>

#include "files/polygons.h"
#include "files/surface_view.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// "path: face 3 (counted from 0)".
std::string name_of_face(const MeshFile& mesh, std::uint64_t face) {
  return mesh.path + ": face " + std::to_string(face) + " (counted from 0)";
}

[[noreturn]] void refuse(const MeshFile& mesh, std::uint64_t face) {
  const auto polygon = mesh.polygons[face];
  std::vector<std::uint32_t> sorted(polygon.begin(), polygon.end());
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    throw Failure(BELTRAMI_E_REPEATED_VERTEX,
                  name_of_face(mesh, face) + " names one vertex twice: split the face",
                  BELTRAMI_ELEMENT_FACE, face);
  }
  throw Failure(name_of_face(mesh, face) +
                    " cannot be cut into triangles without repeating an edge of the mesh: "
                    "triangulate it first",
                BELTRAMI_ELEMENT_FACE, face);
}

/// `repeating` becomes the first face that names a vertex or repeats an edge.
std::vector<std::uint32_t> cut(const MeshFile& mesh, std::uint64_t& repeating) {
  const Polygons& polygons = mesh.polygons;
  const SurfaceView view(mesh);
  std::vector<std::uint32_t> faces(3 * (polygons.corners().size() - 2 * polygons.size()));
  const beltrami_surface surface = view.surface();
  const beltrami_status status =
      beltrami_triangulate(&surface, faces.data(), BELTRAMI_U32, 0, &repeating);
  if (status == BELTRAMI_E_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status < 0) throw Failure(status, mesh.path + ": " + beltrami_status_advice(status));
  return faces;
}

}  // namespace

std::vector<std::uint32_t> triangle_corners(const MeshFile& mesh) {
  std::uint64_t unused = BELTRAMI_NO_ELEMENT;
  return cut(mesh, unused);
}

std::vector<std::uint32_t> triangulate(const MeshFile& mesh) {
  const Polygons& polygons = mesh.polygons;
  if (polygons.all_triangles()) return polygons.corners();
  std::uint64_t repeating = BELTRAMI_NO_ELEMENT;
  std::vector<std::uint32_t> faces = cut(mesh, repeating);
  if (repeating != BELTRAMI_NO_ELEMENT) refuse(mesh, repeating);
  for (std::uint32_t& corner : faces) corner = polygons.corners()[corner];
  return faces;
}

}  // namespace beltrami::cli
