#include "files/write_mesh.h"

#include <algorithm>

#include "files/column.h"
#include "files/polygons.h"

namespace beltrami::cli {

void write_mesh(const MeshFile& mesh, const std::string& path, const Sink& sink) {
  Writer out(sink);
  if (format_of(path) == MeshFormat::kPly) {
    write_ply(mesh, path, out);
  } else {
    write_obj(mesh, path, out);
  }
  out.flush();
}

namespace {

std::vector<std::uint32_t> picked(const std::vector<std::uint32_t>& values,
                                  const std::vector<std::uint32_t>& places) {
  std::vector<std::uint32_t> result;
  if (values.empty()) return result;
  for (const std::uint32_t place : places) result.push_back(values[place]);
  return result;
}

}  // namespace

void cut_faces(MeshFile& mesh, const std::vector<std::uint32_t>& corners) {
  std::vector<std::uint64_t> face_of_triangle;
  std::vector<std::uint64_t> first(mesh.polygons.size() + 1, corners.size() / 3);
  for (std::uint64_t i = 0; i < corners.size(); i += 3) {
    face_of_triangle.push_back(mesh.polygons.of_corner(corners[i]));
    first[face_of_triangle.back()] = std::min(first[face_of_triangle.back()], i / 3);
  }
  mesh.normals.of_corner = picked(mesh.normals.of_corner, corners);
  mesh.corner_uvs.of_corner = picked(mesh.corner_uvs.of_corner, corners);
  for (Column& column : mesh.face_columns) column = picked(column, face_of_triangle);
  for (Statement& statement : mesh.statements) statement.polygon = first[statement.polygon];
  mesh.polygons = Polygons(picked(mesh.polygons.corners(), corners));
}

void replace_faces(MeshFile& mesh, std::vector<std::uint32_t> corners) {
  const bool polygons = !mesh.polygons.all_triangles(), normals = !mesh.normals.of_corner.empty();
  const bool columns = !mesh.face_columns.empty(), statements = !mesh.statements.empty();
  if (polygons) mesh.not_kept.emplace_back("polygons");
  if (normals) mesh.not_kept.emplace_back("normals of corners");
  if (columns) mesh.not_kept.emplace_back("face properties");
  if (statements) mesh.not_kept.emplace_back("groups, materials and lines");
  mesh.polygons = Polygons(std::move(corners));
  mesh.normals = {};
  mesh.face_columns.clear();
  mesh.statements.clear();
}

std::vector<std::string> not_kept(const MeshFile& mesh, const std::string& path) {
  std::vector<std::string> found = mesh.not_kept;
  if (mesh.short_faces > 0) {
    found.push_back(std::to_string(mesh.short_faces) +
                    (mesh.short_faces == 1 ? " face" : " faces") + " of fewer than three corners");
  }
  const MeshFormat format = format_of(path);
  if (format == MeshFormat::kGltf) return found;  // write_gltf says the rest
  if (mesh.gltf) {
    found.emplace_back("nodes, materials, textures, animations and attributes of vertices of glTF");
  }
  const bool ply = format == MeshFormat::kPly;
  for (std::string& what : ply ? not_in_ply(mesh, path) : not_in_obj(mesh, path)) {
    found.push_back(std::move(what));
  }
  return found;
}

}  // namespace beltrami::cli
