#include "mesh_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "failure.h"

namespace beltrami::cli {
namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return extension;
}

std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Failure(path + ": is a directory, not a mesh file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw Failure(path + ": cannot be opened: " + std::strerror(errno));
  std::string text;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  // One byte more, so that the read that fills the buffer also meets the end of the file.
  text.resize(ignored ? 65536 : static_cast<std::size_t>(size) + 1);
  std::size_t used = 0;
  for (;;) {
    if (used == text.size()) text.resize(2 * text.size());
    const std::size_t got = std::fread(text.data() + used, 1, text.size() - used, file.get());
    if (got == 0) break;
    used += got;
  }
  if (std::ferror(file.get())) throw Failure(path + ": cannot be read: " + std::strerror(errno));
  text.resize(used);
  return text;
}

/// Brings text from other systems into the one form that the readers know.
void normalise_text(std::string& text) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.replace(0, 3, 3, ' ');
  const bool lone_returns =
      text.find('\n') == std::string::npos && text.find('\r') != std::string::npos;
  if (lone_returns) std::replace(text.begin(), text.end(), '\r', '\n');
}

}  // namespace

MeshFormat format_of(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  throw Failure(path + ": the format is unknown: use the extension .obj, .off, .ply or .stl");
}

void require_writable_format(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".obj" || extension == ".ply") return;
  throw Failure(path + ": results are written as OBJ or PLY: use the extension .obj or .ply");
}

MeshFile read_mesh(const std::string& path, Content content) {
  const MeshFormat format = format_of(path);
  std::string text = read_file(path);
  if (text.empty()) throw Failure(path + ": the file is empty");
  if (format == MeshFormat::kObj || format == MeshFormat::kOff) normalise_text(text);
  switch (format) {
    case MeshFormat::kObj:
      return read_obj(text, path, content);
    case MeshFormat::kOff:
      return read_off(text, path, content);
    case MeshFormat::kPly:
      return read_ply(text, path, content);
    default:
      return read_stl(text, path, content);
  }
}

}  // namespace beltrami::cli
