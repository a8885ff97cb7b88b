#include "files/write_mesh.h"

#include "files/polygons.h"

namespace beltrami::cli {

void write_mesh(const MeshFile& mesh, const std::string& path, const Sink& sink) {
  Writer out(sink);
  if (format_of(path) == MeshFormat::kPly) {
    write_ply(mesh, out);
  } else {
    write_obj(mesh, out);
  }
  out.flush();
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
  const bool ply = format_of(path) == MeshFormat::kPly;
  for (std::string& what : ply ? not_in_ply(mesh) : not_in_obj(mesh)) {
    found.push_back(std::move(what));
  }
  return found;
}

}  // namespace beltrami::cli
