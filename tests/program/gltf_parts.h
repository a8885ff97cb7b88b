// A scene of a square, what the writer made of it, and that taken apart without the reader.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "gltf_builder.h"

namespace beltrami::cli {

using Json = GltfBuilder::Json;
using Corners = std::vector<std::uint32_t>;

/// A GLB file taken apart, without the reader under test.
struct Parts {
  Json json;
  std::string chunk;

  explicit Parts(const std::string& glb) {
    const std::size_t length = number<std::uint32_t>(glb, 12);
    json = Json::parse(glb.substr(20, length));
    chunk = glb.substr(28 + length, number<std::uint32_t>(glb, 20 + length));
  }

  template <class Number>
  static Number number(const std::string& bytes, std::size_t at) {
    Number found;
    std::memcpy(&found, bytes.data() + at, sizeof found);
    return found;
  }

  std::string view(const Json& number) const {
    const Json& found = json["bufferViews"][number.get<std::size_t>()];
    return chunk.substr(found["byteOffset"], found["byteLength"]);
  }
  /// The numbers of an accessor; `padded`: the width that elements have in the buffer.
  template <class Number>
  std::vector<Number> values(const Json& accessor, std::size_t width, std::size_t padded) const {
    const Json& found = json["accessors"][accessor.get<std::size_t>()];
    const std::string bytes = view(found["bufferView"]);
    std::vector<Number> all;
    for (std::size_t i = 0; i < found["count"]; ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        all.push_back(number<Number>(bytes, (i * padded + k) * sizeof(Number)));
      }
    }
    return all;
  }
  const Json& primitive(std::size_t mesh, std::size_t number = 0) const {
    return json["meshes"][mesh]["primitives"][number];
  }
  std::size_t count(const Json& accessor) const {
    return json["accessors"][accessor.get<std::size_t>()]["count"];
  }
};

inline std::string joined(const GltfOutput::File& file) {
  return std::accumulate(file.pieces.begin(), file.pieces.end(), std::string());
}

inline MeshFile read_bytes(const std::string& bytes, const std::string& path = "a.glb") {
  return read_gltf(bytes, path, Content::kSurface);
}

/// UVs that tell corners apart: (number, 1/4) for UV vertex `number`.
inline GltfOutput write_with_uvs(MeshFile file, const Corners& uv_vertices,
                                 std::uint32_t uv_set = 0, const std::string& path = "b.glb") {
  const std::uint32_t last = *std::max_element(uv_vertices.begin(), uv_vertices.end());
  for (std::uint32_t i = 0; i <= last; ++i) {
    file.corner_uvs.values.insert(file.corner_uvs.values.end(), {double(i), 0.25});
  }
  file.corner_uvs.of_corner = uv_vertices;
  return write_gltf(file, uv_set, path);
}

/// Of every corner.
inline std::vector<double> corner_uvs(const MeshFile& file, std::uint32_t uv_set) {
  const std::vector<double> uvs = gltf_uvs(file, uv_set);
  std::vector<double> found;
  for (const std::uint32_t vertex : file.polygons.corners()) {
    for (std::size_t k = 0; k < 2; ++k) found.push_back(uvs[2 * std::size_t{vertex} + k]);
  }
  return found;
}

inline Parts written(const GltfBuilder& builder, const Corners& uv_vertices,
                     std::uint32_t uv_set = 0) {
  const GltfOutput output = write_with_uvs(read_bytes(builder.text()), uv_vertices, uv_set);
  return Parts(joined(output.files.back()));
}

/// Two triangles of a square, 0 1 2 and 0 2 3, with what vertices can have.
inline GltfBuilder rich_square() {
  GltfBuilder builder;
  Json attributes = {
      {"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})},
      {"NORMAL", builder.vectors3({0, 0, 1, 0, 0, -1, 0, 1, 0, 1, 0, 0})},
      {"TANGENT",
       builder.accessor<float>("VEC4", 4, {1, 0, 0, 1, 2, 0, 0, 1, 3, 0, 0, 1, 4, 0, 0, 1})},
      {"TEXCOORD_0", builder.vectors2({.1f, .2f, .3f, .4f, .5f, .6f, .7f, .8f})},
      // Three bytes and one that is nothing.
      {"COLOR_0", builder.accessor<std::uint8_t>(
                      "VEC3", 4, {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0})},
      {"JOINTS_0",
       builder.accessor<std::uint8_t>("VEC4", 4, {0, 1, 2, 3, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3})},
      {"WEIGHTS_0", builder.accessor<std::uint16_t>(
                        "VEC4", 4, {9, 0, 0, 0, 8, 0, 0, 0, 7, 0, 0, 0, 6, 0, 0, 0})},
      {"_PART", builder.accessor<std::uint16_t>("SCALAR", 2, {1, 0, 2, 0, 3, 0, 4, 0})}};
  for (const char* name : {"COLOR_0", "_PART"}) {
    Json& accessor = builder.json["accessors"][attributes[name].get<std::size_t>()];
    builder.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteStride"] = 4;
  }
  Json& positions = builder.json["accessors"][0];
  positions["min"] = {0, 0, 0};
  positions["max"] = {1, 1, 0};
  positions["name"] = "places";
  Json& primitive =
      builder.mesh(std::move(attributes), builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
  primitive["targets"] = {{{"POSITION", builder.vectors3({0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4})}}};
  // Only vertex 2 moves.
  const int places = builder.view({2}),
            values = builder.view(GltfBuilder::bytes_of_all<float>({5, 6, 7}));
  builder.json["accessors"].push_back(
      {{"componentType", 5126},
       {"count", 4},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", places}, {"componentType", 5121}}},
         {"values", {{"bufferView", values}}}}}});
  primitive["targets"].push_back({{"POSITION", builder.json["accessors"].size() - 1}});
  return builder;
}

/// UV vertices of the square's corners that cut it along the diagonal, at vertex 0 alone or at 2
/// too.
inline const Corners kWhole = {0, 1, 2, 0, 2, 3}, kCut = {0, 1, 2, 4, 5, 3};

}  // namespace beltrami::cli
