// glTF documents of a few triangles, with whatever a test is about.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "binary.h"
#include "files/gltf/uri.h"

namespace beltrami::cli {

/// A document that grows: `json` is for the test to edit.
class GltfBuilder {
 public:
  using Json = nlohmann::ordered_json;

  Json json = {{"asset", {{"version", "2.0"}}},
               {"accessors", Json::array()},
               {"bufferViews", Json::array()}};

  /// The number of an accessor of these values, in a buffer view of its own.
  template <class Number>
  int accessor(const char* type, std::size_t width, std::initializer_list<Number> values) {
    const int bytes = view(bytes_of_all(values));
    json["accessors"].push_back({{"bufferView", bytes},
                                 {"componentType", component<Number>()},
                                 {"count", values.size() / width},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int vectors3(std::initializer_list<float> values) { return accessor("VEC3", 3, values); }
  int vectors2(std::initializer_list<float> values) { return accessor("VEC2", 2, values); }
  template <class Number>
  int indices(std::initializer_list<Number> values) {
    return accessor("SCALAR", 1, values);
  }

  /// The number of a buffer view of these bytes.
  int view(const std::string& bytes) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
    buffer_ += bytes;
    buffer_.append((4 - buffer_.size() % 4) % 4, '\0');
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  /// Adds a mesh of one primitive.
  Json& mesh(Json attributes, int indices = -1) {
    Json primitive = {{"attributes", std::move(attributes)}};
    if (indices >= 0) primitive["indices"] = indices;
    json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
    return json["meshes"].back()["primitives"][0];
  }

  /// A .gltf file: its buffer is in itself, or has this URI.
  std::string text(const std::string& uri = {}) const {
    Json whole = json;
    whole["buffers"] = Json::array({{{"byteLength", buffer_.size()},
                                     {"uri", uri.empty() ? gltf::encode_data(buffer_) : uri}}});
    return whole.dump(1);
  }
  /// A .glb file.
  std::string glb() const {
    Json whole = json;
    whole["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    return glb_of(whole.dump(), buffer_);
  }
  const std::string& buffer() const { return buffer_; }

  static std::string glb_of(std::string json, std::string chunk) {
    json.append((4 - json.size() % 4) % 4, ' ');
    chunk.append((4 - chunk.size() % 4) % 4, '\0');
    const auto size = [](std::size_t bytes) {
      return bytes_of(static_cast<std::uint32_t>(bytes), false);
    };
    return "glTF" + size(2) + size(12 + 8 + json.size() + 8 + chunk.size()) + size(json.size()) +
           "JSON" + json + size(chunk.size()) + std::string("BIN\0", 4) + chunk;
  }

  template <class Number>
  static std::string bytes_of_all(std::initializer_list<Number> values) {
    std::string bytes;
    for (const Number value : values) bytes += bytes_of(value, false);
    return bytes;
  }

 private:
  template <class Number>
  static constexpr int component() {
    if constexpr (std::is_same_v<Number, float>) return 5126;
    const int size = sizeof(Number) == 1 ? 5120 : sizeof(Number) == 2 ? 5122 : 5124;
    return size + (std::is_unsigned_v<Number> ? 1 : 0);
  }

  std::string buffer_;
};

}  // namespace beltrami::cli
