#include "files/gltf/container.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include "files/gltf/little.h"
#include "files/gltf/uri.h"
#include "process/failure.h"

namespace beltrami::cli::gltf {
namespace {

namespace fs = std::filesystem;

bool is_glb(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  return extension.size() == 4;  // else it is .gltf
}

/// scene.bin, scene-1.bin, scene-2.bin beside scene.gltf.
std::string buffer_name(const std::string& path, std::uint64_t number) {
  fs::path name = fs::path(path).replace_extension();
  if (number > 0) (name += "-") += std::to_string(number);
  return (name += ".bin").string();
}

/// Whether buffer_name may have made it, without folders.
bool is_buffer_name(const std::string& name, const std::string& path) {
  constexpr std::string_view kEnd = ".bin";
  const std::string stem = fs::path(path).stem().string();
  if (!name.starts_with(stem) || !name.ends_with(kEnd)) return false;
  if (name.size() < stem.size() + kEnd.size()) return false;
  const std::string number = name.substr(stem.size(), name.size() - stem.size() - kEnd.size());
  return number.empty() || (number[0] == '-' && number.size() > 1 &&
                            number.find_first_not_of("0123456789", 1) == std::string::npos);
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

fs::path folder_of(const std::string& path) {
  std::error_code ignored;  // what cannot be resolved is compared as it is
  const fs::path folder = fs::absolute(path, ignored).parent_path();
  return fs::weakly_canonical(folder, ignored);
}

}  // namespace

std::string buffer_path(const Document& document, const std::string& path) {
  if (is_glb(path) || document.storage != Storage::kFile) return {};
  for (std::uint64_t number = 0;; ++number) {
    std::string name = buffer_name(path, number);
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

std::vector<std::string> buffers_replaced(const Document& document, const std::string& path) {
  std::error_code ignored;
  if (is_glb(path) || !fs::is_regular_file(path, ignored)) return {};
  std::ifstream file(path, std::ios::binary);
  const Json old = Json::parse(file, nullptr, false);
  if (!old.is_object() || !old.contains("buffers") || !old["buffers"].is_array()) return {};
  const bool in_place = fs::equivalent(document.path, path, ignored);
  std::vector<std::string> found;
  for (const Json& buffer : old["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string& uri = buffer["uri"].get_ref<const std::string&>();
    const std::optional<std::string> name = is_data(uri) ? std::nullopt : decode_path(uri);
    if (!name || !is_buffer_name(*name, path)) continue;
    const std::string own = fs::path(path).replace_filename(*name).string();
    const bool needed =
        std::any_of(document.files.begin(), document.files.end(),
                    [&](const auto& input) { return fs::equivalent(input.first, own, ignored); });
    if (fs::is_regular_file(own, ignored) && (in_place || !needed)) found.push_back(own);
  }
  return found;
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
    uri = encode_path(fs::path(beside).filename().string());
    files.push_back({beside, std::move(buffer.pieces)});
  }
  files.push_back({path, {json.dump(2), "\n"}});
  return files;
}

std::vector<std::string> images_left_behind(const Document& document, const Json& json,
                                            const std::string& path) {
  std::vector<std::string> found;
  if (folder_of(document.path) == folder_of(path)) return found;
  for (std::uint64_t i = 0; i < document.count("images"); ++i) {
    const Item image = document.entry("images", i);
    const Json* uri = image.find("uri");
    const bool replaced = json["images"][i] != image.json;
    if (replaced || !uri || !uri->is_string() || is_data(uri->get_ref<const std::string&>()))
      continue;
    const std::optional<std::string> file = decode_path(uri->get_ref<const std::string&>());
    if (file) found.push_back(*file);
  }
  return found;
}

}  // namespace beltrami::cli::gltf
