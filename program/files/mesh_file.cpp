#include "files/mesh_file.h"

#include <algorithm>
#include <filesystem>

#include "process/descriptor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return extension;
}

/// Brings text from other systems into the one form that the readers know.
void normalise_text(std::string& text) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.replace(0, 3, 3, ' ');
  const bool lone_returns =
      text.find('\n') == std::string::npos && text.find('\r') != std::string::npos;
  if (lone_returns) std::replace(text.begin(), text.end(), '\r', '\n');
}

/// Whether this is a surface of the Montreal Neurological Institute: "P" and five numbers, where
/// Wavefront's "p" would have vertices that are yet to come.
bool is_mni(std::string_view text) {
  return text.substr(0, 2) == "P ";
}

/// The reader of the format, on the text of the file.
MeshFile read_text(const std::string& path, Content content, Reach reach) {
  const MeshFormat format = format_of(path);
  std::string text = read_file(path);
  if (text.empty()) throw Failure(path + ": the file is empty");
  if (format == MeshFormat::kObj || format == MeshFormat::kOff) normalise_text(text);
  switch (format) {
    case MeshFormat::kObj:
      return is_mni(text) ? read_mni(text, path, content) : read_obj(text, path, content);
    case MeshFormat::kOff:
      return read_off(text, path, content);
    case MeshFormat::kPly:
      return read_ply(text, path, content);
    case MeshFormat::kStl:
      return read_stl(text, path, content);
    default:
      return read_gltf(text, path, content, reach);
  }
}

}  // namespace

MeshFormat format_of(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::kGltf;
  throw Failure(path +
                ": the format is unknown: use the extension .obj, .off, .ply, .stl, .gltf or .glb");
}

void require_writable_format(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj" || extension == ".ply") return;
  throw Failure(path + ": results are written as OBJ or PLY: use the extension .obj or .ply");
}

void unite_corner_uvs(MeshFile& mesh) {
  const auto& [values, of_corner] = mesh.corner_uvs;
  const std::vector<std::uint32_t>& vertices = mesh.polygons.corners();
  std::vector<double> uvs(2 * mesh.vertex_count(), 0.0);
  std::vector<bool> known(mesh.vertex_count(), false);
  for (std::size_t c = 0; c < vertices.size(); ++c) {
    const double* uv = &values[2 * std::size_t{of_corner[c]}];
    double* of_vertex = &uvs[2 * std::size_t{vertices[c]}];
    // Written so that NaN is no second UV: the library refuses it with its face.
    if (known[vertices[c]] && (uv[0] < of_vertex[0] || uv[0] > of_vertex[0] ||
                               uv[1] < of_vertex[1] || uv[1] > of_vertex[1])) {
      return;
    }
    std::copy(uv, uv + 2, of_vertex);
    known[vertices[c]] = true;
  }
  mesh.uvs = std::move(uvs);
  mesh.corner_uvs = {};
}

void require_whole(const MeshFile& mesh) {
  if (!mesh.truncated.empty()) throw Failure(mesh.path + ": " + mesh.truncated);
}

MeshFile read_mesh(const std::string& path, Content content, Reach reach) {
  MeshFile mesh = read_text(path, content, reach);
  mesh.path = path;
  return mesh;
}

}  // namespace beltrami::cli
