#include "files/mesh_file.h"

#include <algorithm>
#include <cstddef>
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

/// Brings the text in front of `end` from other systems into the one form that the readers know.
void normalise_text(std::string& text, std::size_t end) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.replace(0, 3, 3, ' ');
  const std::string_view head = std::string_view(text).substr(0, end);
  if (head.find('\n') != std::string_view::npos) return;
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(head.size()), '\r', '\n');
}

/// Where the text of a file ends: what follows the header of a PLY file may be binary, as may all
/// of an STL file.
std::size_t text_end(MeshFormat format, std::string_view text) {
  if (format == MeshFormat::kObj || format == MeshFormat::kOff) return text.size();
  if (format == MeshFormat::kStl) {
    return text.find('\0') == std::string_view::npos ? text.size() : 0;
  }
  if (format != MeshFormat::kPly) return 0;
  constexpr std::string_view kEnd = "end_header";
  const std::size_t end = text.find(kEnd);
  if (end == std::string_view::npos || text.find("format ascii") < end) return text.size();
  return std::min(text.size(), end + kEnd.size() + 1);
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
  normalise_text(text, text_end(format, text));
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
  if (is_gltf_name(path)) return MeshFormat::kGltf;
  throw Failure(path +
                ": the format is unknown: use the extension .obj, .off, .ply, .stl, .gltf or .glb");
}

void require_writable_format(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj" || extension == ".ply") return;
  throw Failure(path +
                ": results are written as OBJ, PLY or glTF: use the extension "
                ".obj, .ply, .gltf or .glb");
}

bool is_gltf_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".gltf" || extension == ".glb";
}

void require_png_name(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension.empty() || extension == ".png") return;
  throw Failure(path + ": pictures are written as PNG: use the extension .png");
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
  mesh.reach = reach;
  return mesh;
}

}  // namespace beltrami::cli
