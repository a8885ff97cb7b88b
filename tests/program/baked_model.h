// Models with textures, before and after they are baked.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "picture/stb_in_one_place.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {

using Texel = std::array<double, 3>;
using Uv = std::array<double, 2>;
/// What is shown at a place of [0, 1]^2, from 0 to 255, rows from the top.
using Shown = std::function<Texel(double x, double y)>;

inline constexpr double kPi = 3.14159265358979323846;

inline std::string png_of(int side, const Shown& shown) {
  std::vector<std::uint8_t> values;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      for (const double value : shown((column + 0.5) / side, (row + 0.5) / side)) {
        values.push_back(static_cast<std::uint8_t>(value + 0.5));
      }
    }
  }
  return png_bytes(side, side, 3, values.data());
}

inline Texel smooth(double x, double y) {
  const double a = 2 * kPi * x, b = 2 * kPi * y;
  return {128 + 100 * std::sin(a), 128 + 100 * std::cos(b), 128 + 60 * std::sin(a + b)};
}

/// An image between its texels, repeated; `uv` with its V axis down, as in glTF.
inline Texel read_at(const Pixels& image, const Uv& uv) {
  const double x = uv[0] * image.width - 0.5, y = uv[1] * image.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  Texel found{};
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const auto wrapped = [](double at, int count) {
        return static_cast<std::size_t>(at - count * std::floor(at / count));
      };
      const std::size_t texel = wrapped(top + j, image.height) * std::size_t(image.width) +
                                wrapped(left + i, image.width);
      const double weight = (i ? x - left : 1 - x + left) * (j ? y - top : 1 - y + top);
      for (std::size_t k = 0; k < 3; ++k) found[k] += weight * image.values[3 * texel + k];
    }
  }
  return found;
}

/// A strip of two squares in space, bent by a right angle, each with UVs of its own.
inline GltfBuilder bent_strip(std::initializer_list<float> uvs) {
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                               1, 0, 0, 1, 0, 1, 1, 1, 1, 1, 1, 0})},
                {"TEXCOORD_0", builder.vectors2(uvs)}},
               builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  return builder;
}

/// Adds an image, and has the material show it in a slot.
inline void add_texture(GltfBuilder& builder, const std::string& png, const std::string& slot,
                        const Json& sampler = Json::object(), const Json& extension = Json()) {
  auto& json = builder.json;
  const int view = builder.view(png);
  json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  json["samplers"].push_back(sampler);
  const std::size_t number = json["images"].size() - 1;
  json["textures"].push_back({{"source", number}, {"sampler", number}});
  Json info = {{"index", number}};
  if (!extension.is_null()) info["extensions"] = {{"KHR_texture_transform", extension}};
  Json& material = json["materials"][0];
  (slot == "baseColorTexture" ? material["pbrMetallicRoughness"] : material)[slot] = info;
}

/// A GLB file before and after.
class BakedModel {
 public:
  explicit BakedModel(const GltfBuilder& builder, std::vector<std::string> options = {})
      : before(read_gltf(builder.glb(), "a.glb", Content::kUvs)) {
    const std::string in = directory.file("in.glb", builder.glb()), out = directory.path("out.glb");
    std::vector<std::string> words = {"unwrap", in, out, "--bake", "--resolution", "256"};
    words.insert(words.end(), options.begin(), options.end());
    outcome = run(words);
    if (outcome.exit_code != 0) return;
    parts.emplace(directory.read("out.glb"));
    after = read_gltf(directory.read("out.glb"), "out.glb", Content::kUvs);
  }

  Pixels image(const Json& info) const {
    const Json& texture = parts->json["textures"][info["index"].get<std::size_t>()];
    const Json& found = parts->json["images"][texture["source"].get<std::size_t>()];
    return *read_image(parts->view(found["bufferView"]));
  }
  Pixels base_colour() const {
    return image(parts->json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]);
  }
  /// Calls visit(old UV, new UV) at places on faces, both with the V axis down.
  void visit(const std::function<void(std::size_t face, const Uv&, const Uv&)>& visit) const {
    for (std::size_t face = 0; face < before.polygons.size(); ++face) {
      for (double a = 0.02; a < 1; a += 0.06) {
        for (double b = 0.02; a + b < 0.99; b += 0.06) {
          visit(face, at(before, face, a, b), at(after, face, a, b));
        }
      }
    }
  }
  static Uv at(const MeshFile& file, std::size_t face, double a, double b) {
    const std::array<double, 3> weights = {1 - a - b, a, b};
    Uv uv{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex = file.polygons.corners()[3 * face + k];
      uv[0] += weights[k] * file.uvs[2 * vertex];
      uv[1] += weights[k] * (1 - file.uvs[2 * vertex + 1]);
    }
    return uv;
  }
  /// In decibels, of what the model shows now against `shown` at the old UVs.
  double psnr(const Pixels& now, const std::function<Texel(const Uv&)>& shown) const {
    double sum = 0;
    int count = 0;
    visit([&](std::size_t, const Uv& old_uv, const Uv& new_uv) {
      const Texel is = read_at(now, new_uv), was = shown(old_uv);
      for (std::size_t k = 0; k < 3; ++k) sum += (is[k] - was[k]) * (is[k] - was[k]);
      count += 3;
    });
    return 10 * std::log10(255 * 255 / (sum / count + 1e-12));
  }

  TemporaryDirectory directory;
  MeshFile before, after;
  Outcome outcome;
  std::optional<Parts> parts;
};

inline const std::initializer_list<float> kTwoHalves = {0,   0, .5f, 0, .5f, 1, 0,   1,
                                                        .5f, 0, 1,   0, 1,   1, .5f, 1};

}  // namespace beltrami::cli
