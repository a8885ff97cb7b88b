#include "files/gltf/container.h"

#include <filesystem>
#include <limits>
#include <optional>

#include "files/gltf/little.h"
#include "files/gltf/uri.h"
#include "process/failure.h"

namespace beltrami::cli::gltf {
namespace {

bool is_glb(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension.size() == 4;  // else it is .gltf
}

GltfOutput::File glb(const Json& json, Buffer buffer, const std::string& path) {
  std::string text = json.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::uint64_t padding = (4 - buffer.size % 4) % 4;
  const std::uint64_t chunk = buffer.size + padding, total = 12 + 8 + text.size() + 8 + chunk;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Failure(path + ": a GLB file holds no more than 4 GiB: use the extension .gltf");
  }
  std::string head = "glTF";
  append_little(head, std::uint32_t{2});
  append_little(head, static_cast<std::uint32_t>(total));
  append_little(head, static_cast<std::uint32_t>(text.size()));
  head += "JSON" + text;
  append_little(head, static_cast<std::uint32_t>(chunk));
  head += std::string("BIN\0", 4);
  GltfOutput::File file{path, {std::move(head)}};
  for (std::string& piece : buffer.pieces) file.pieces.push_back(std::move(piece));
  file.pieces.emplace_back(padding, '\0');
  return file;
}

std::filesystem::path folder_of(const std::string& path) {
  std::error_code ignored;  // what cannot be resolved is compared as it is
  const std::filesystem::path folder = std::filesystem::absolute(path, ignored).parent_path();
  return std::filesystem::weakly_canonical(folder, ignored);
}

}  // namespace

std::string buffer_path(const Document& document, const std::string& path) {
  if (is_glb(path) || document.storage != Storage::kFile) return {};
  return std::filesystem::path(path).replace_extension(".bin").string();
}

std::vector<GltfOutput::File> files_of(const Document& document, Json json, Buffer buffer,
                                       const std::string& path) {
  std::vector<GltfOutput::File> files;
  if (is_glb(path)) {
    files.push_back(glb(json, std::move(buffer), path));
    return files;
  }
  Json& uri = json["buffers"][0]["uri"];
  const std::string beside = buffer_path(document, path);
  if (beside.empty()) {
    std::string bytes;
    bytes.reserve(buffer.size);
    for (const std::string& piece : buffer.pieces) bytes += piece;
    uri = encode_data(bytes);
  } else {
    uri = encode_path(std::filesystem::path(beside).filename().string());
    files.push_back({beside, std::move(buffer.pieces)});
  }
  files.push_back({path, {json.dump(2), "\n"}});
  return files;
}

std::vector<std::string> images_left_behind(const Document& document, const std::string& path) {
  std::vector<std::string> found;
  if (folder_of(document.path) == folder_of(path)) return found;
  for (std::uint64_t i = 0; i < document.count("images"); ++i) {
    const Item image = document.entry("images", i);
    const Json* uri = image.find("uri");
    if (!uri || !uri->is_string() || is_data(uri->get_ref<const std::string&>())) continue;
    const std::optional<std::string> file = decode_path(uri->get_ref<const std::string&>());
    if (file) found.push_back(*file);
  }
  return found;
}

}  // namespace beltrami::cli::gltf
