// glTF: bytes at random, and documents of which values are exchanged in the tree.
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "file_promises.h"
#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "files/texture_use.h"
#include "process/failure.h"
#include "target.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace beltrami::fuzz {
namespace {

using cli::MeshFile;
using Json = nlohmann::ordered_json;

void judge_textures(const MeshFile& file) {
  try {
    for (const cli::TextureUse& use : cli::gltf_textures(file)) {
      cli::gltf_faces_of(file, use.material);
      cli::gltf_image(file, use);
    }
    cli::gltf_sources(file);
  } catch (const cli::Failure& failure) {
    promise(*failure.what() != '\0', "a refusal has a sentence");
  }
  cli::gltf_attribute(file, "NORMAL", 3);
}

/// With a UV of its own for every corner it is written, and read back with these.
void judge_output(MeshFile file) {
  const std::vector<std::uint32_t> corners = file.polygons.corners();
  file.corner_uvs = {};
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    file.corner_uvs.of_corner.push_back(c);
    file.corner_uvs.values.insert(file.corner_uvs.values.end(), {double(c), 0.5});
  }
  for (const char* path : {"b.glb", "b.gltf"}) {
    try {
      std::string bytes;
      const cli::GltfOutput output = cli::write_gltf(file, 0, path);
      for (const std::string& piece : output.files.back().pieces) bytes += piece;
      const MeshFile back = cli::read_gltf(bytes, path, cli::Content::kAll);
      promise(back.polygons.corners().size() == corners.size(), "corners are read back");
      for (std::size_t c = 0; c < corners.size(); ++c) {
        promise(back.uvs[2 * std::size_t{back.polygons.corners()[c]}] == double(c),
                "every corner has its UV back");
      }
    } catch (const cli::Failure&) {
      broken("what was read is written, and read back");
    }
  }
}

/// The JSON of a text or binary file, or something else.
Json parsed(std::string_view bytes, std::string& chunk) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return std::size_t{value};
  };
  if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF") {
    return Json::parse(bytes, nullptr, false);
  }
  const std::size_t length = std::min(number(12), bytes.size() - 20);
  if (bytes.size() > 28 + length) chunk = bytes.substr(28 + length);
  return Json::parse(bytes.substr(20, length), nullptr, false);
}

std::string binary(std::string json, std::string chunk) {
  const auto bytes_of = [](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    return bytes;
  };
  json.append((4 - json.size() % 4) % 4, ' ');
  chunk.append((4 - chunk.size() % 4) % 4, '\0');
  return "glTF" + bytes_of(2) + bytes_of(28 + json.size() + chunk.size()) + bytes_of(json.size()) +
         "JSON" + json + bytes_of(chunk.size()) + std::string("BIN\0", 4) + chunk;
}

void collect(Json& json, std::vector<Json*>& all) {
  all.push_back(&json);
  if (!json.is_structured()) return;
  for (Json& child : json) collect(child, all);
}

/// Exchanges, adds or removes a value somewhere in the tree.
void mutate(Json& json, std::mt19937& random) {
  static const Json pieces = Json::parse(
      R"([-1, 0, 1, 2, 3, 4, 5, 6, 9, 12, 5120, 5121, 5123, 5125, 5126, 4294967295, 0.5, 1e300,
          18446744073709551615, 9007199254740993, null, true, "", "VEC2", "VEC3", "VEC4", "MAT4",
          "SCALAR", [], {}, [0], {"bufferView": 0}, "data:application/octet-stream;base64,AAAA",
          "../a", "/etc/passwd", "data:,", [0, 0, 0, 1]])");
  static const std::vector<std::string> keys = {
      "bufferView", "byteOffset", "byteLength", "byteStride", "sparse",   "count",
      "normalized", "mode",       "indices",    "material",   "targets",  "children",
      "matrix",     "extensions", "min",        "buffers",    "uri",      "texCoord",
      "NORMAL",     "TEXCOORD_0", "extras",     "TEXCOORD_1", "images",   "source",
      "mesh",       "skin",       "scale",      "rotation",   "mappings", "TANGENT"};
  std::vector<Json*> all;
  collect(json, all);
  Json& at = *all[random() % all.size()];
  Json piece = random() % 4 ? pieces[random() % pieces.size()] : *all[random() % all.size()];
  if (at.is_object() && random() % 2) {
    at[keys[random() % keys.size()]] = std::move(piece);
  } else if (at.is_structured() && !at.empty() && random() % 2) {
    at.erase(std::next(at.begin(), static_cast<std::ptrdiff_t>(random() % at.size())));
  } else {
    at = std::move(piece);
  }
}

}  // namespace

void run_one(std::string_view bytes) {
  MeshFile file;
  try {
    file = cli::read_gltf(bytes, "no_such_folder/a", cli::Content::kSurface);
    cli::read_gltf(bytes, "no_such_folder/a", cli::Content::kAll);
  } catch (const cli::Failure& failure) {
    promise(*failure.what() != '\0', "a refusal has a sentence");
    if (!file.gltf) return;
  }
  judge_file(file);
  judge_textures(file);
  judge_output(std::move(file));
}

}  // namespace beltrami::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  using namespace beltrami::fuzz;
  std::mt19937 random(seed);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::string chunk;
  if (random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  Json json = parsed(bytes, chunk);
  if (json.is_discarded()) return LLVMFuzzerMutate(data, size, most);
  for (std::size_t n = 1 + random() % 3; n > 0; --n) mutate(json, random);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (bytes.starts_with("glTF")) text = binary(std::move(text), std::move(chunk));
  if (text.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
