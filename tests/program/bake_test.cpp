// beltrami unwrap --bake, end to end, and the engine that it shares with transfer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "baked_model.h"
#include "commands/bake_call.h"
#include "commands/command.h"
#include "files/mesh_file.h"
#include "files/texture_use.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

constexpr const char* kWoodenSquare =
    "mtllib in.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl wood\nf 1/1 2/2 3/3 4/4\n";

TEST(Bake, ASmoothTextureShowsTheSameAtTheNewUvs) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, png_of(256, smooth), "baseColorTexture");
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels before = *read_image(png_of(256, smooth)), now = model.base_colour();
  EXPECT_EQ(now.width, 256);
  EXPECT_GE(model.psnr(now, [&](const Uv& uv) { return read_at(before, uv); }), 40);
  EXPECT_EQ(model.parts->json["images"].size(), 1u) << "the old one is gone";
  EXPECT_EQ(model.outcome.err, "");
}

TEST(Bake, AFloorThatRepeatsReadsTheTextureEveryTime) {
  GltfBuilder builder = bent_strip({0, 0, 2, 0, 2, 2, 0, 2, 0, 0, 2, 0, 2, 2, 0, 2});
  add_texture(builder, png_of(64, smooth), "baseColorTexture");
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels before = *read_image(png_of(64, smooth));
  EXPECT_GE(model.psnr(model.base_colour(), [&](const Uv& uv) { return read_at(before, uv); }), 36);
}

TEST(Bake, SamplersAndTransformsSayWhereATextureIsRead) {
  GltfBuilder builder = bent_strip({0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1});
  const double angle = 0.5;
  add_texture(builder, png_of(128, smooth), "baseColorTexture",
              {{"wrapS", 33648}, {"wrapT", 33648}},
              {{"offset", {0.25, -0.5}}, {"rotation", angle}, {"scale", {1.5, 0.75}}});
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const auto mirrored = [](double x) {
    const double period = x - 2 * std::floor(x / 2);
    return period > 1 ? 2 - period : period;
  };
  const double c = std::cos(angle), s = std::sin(angle);
  const double found = model.psnr(model.base_colour(), [&](const Uv& uv) {
    const double u = 1.5 * uv[0], v = 0.75 * uv[1];
    return smooth(mirrored(c * u + s * v + 0.25), mirrored(-s * u + c * v - 0.5));
  });
  EXPECT_GE(found, 36);
  const Json& info = model.parts->json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  EXPECT_FALSE(info.contains("extensions")) << info;
}

TEST(Bake, NothingIsSeenAcrossASeam) {
  // One square, cut by the seam that two separate vertices make: both sides show the same.
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, png_of(256, smooth), "baseColorTexture");
  const BakedModel model(builder, {"--hard-angle", "60"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels now = model.base_colour();
  for (double t = 0.02; t < 1; t += 0.02) {
    // The edge from vertex 1 to 2 of the first square is that from 4 to 7 of the second.
    const Texel left = read_at(now, BakedModel::at(model.after, 0, 1 - t, t));
    const Texel right = read_at(now, BakedModel::at(model.after, 3, 0, t));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(left[k], right[k], 4) << t;
  }
}

TEST(Bake, MirroredHalvesKeepTheirNormals) {
  // The second square shows the first half of the image mirrored. What tilts to
  // the left and up on the image does so along the old UVs of either square, one of which is
  // mirrored, whatever the new ones are.
  GltfBuilder builder = bent_strip({0, 0, .5f, 0, .5f, 1, 0, 1, .5f, 0, 0, 0, 0, 1, .5f, 1});
  const auto tilted = [](double, double) { return Texel{60, 172, 230}; };
  add_texture(builder, png_of(128, tilted), "normalTexture");
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels now = model.image(model.parts->json["materials"][0]["normalTexture"]);
  // On the image u is x of the first square and -z of the second, and up is -y of both.
  const double left = 67.5, up = 44.5, size = std::hypot(left, up);
  const std::array<std::array<double, 3>, 2> along = {
      {{-left / size, -up / size, 0}, {0, -up / size, left / size}}};
  model.visit([&](std::size_t face, const Uv&, const Uv& new_uv) {
    const Texel texel = read_at(now, new_uv);
    // The gradient of the new u and v in space, from the corners.
    std::array<std::array<double, 3>, 2> p{};
    std::array<Uv, 3> uv = {BakedModel::at(model.after, face, 0, 0),
                            BakedModel::at(model.after, face, 1, 0),
                            BakedModel::at(model.after, face, 0, 1)};
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        const auto position = [&](std::size_t corner) {
          const std::size_t vertex = model.after.polygons.corners()[3 * face + corner];
          return model.after.positions[3 * vertex + d];
        };
        p[k][d] = position(k + 1) - position(0);
      }
    }
    const double u1 = uv[1][0] - uv[0][0], v1 = uv[0][1] - uv[1][1], u2 = uv[2][0] - uv[0][0],
                 v2 = uv[0][1] - uv[2][1], area = u1 * v2 - u2 * v1;
    EXPECT_GT(area, 0) << "new charts are never mirrored";
    std::array<double, 3> shown{};
    double length_u = 0, length_v = 0;
    std::array<double, 3> along_u{}, along_v{};
    for (std::size_t d = 0; d < 3; ++d) {
      along_u[d] = (p[0][d] * v2 - p[1][d] * v1) / area;
      along_v[d] = (p[1][d] * u1 - p[0][d] * u2) / area;
      length_u += along_u[d] * along_u[d];
      length_v += along_v[d] * along_v[d];
    }
    const double x = texel[0] - 127.5, y = texel[1] - 127.5, flat = std::hypot(x, y);
    for (std::size_t d = 0; d < 3; ++d) {
      shown[d] =
          (x * along_u[d] / std::sqrt(length_u) + y * along_v[d] / std::sqrt(length_v)) / flat;
      EXPECT_NEAR(shown[d], along[face / 2][d], 0.03) << "face " << face;
    }
    EXPECT_NEAR(flat, size, 1.5);
    EXPECT_NEAR(texel[2], 230, 1);
  });
}

TEST(Bake, ANormalMapTurnsWithItsChart) {
  // The new axis of u is the old one of v: what tilted along the old u tilts along -v now.
  BakeCall call;
  call.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  call.old_uvs = {0, 0, 1, 0, 0, 1};
  call.new_uvs = {0, 1, 0, 0, 1, 1};
  call.images = {Pixels{1, 1, 3, {200, 128, 220}}};
  call.meaning = Meaning::kDirections;
  call.side = 16;
  EXPECT_EQ(call.run(make_context().get(), "a", {}).without_source, 0u);
  const std::uint8_t* texel = &call.pages.front().values[3 * (16 * 4 + 2)];
  EXPECT_NEAR(texel[0], 128, 1);
  EXPECT_NEAR(texel[1], 55, 1);
  EXPECT_EQ(texel[2], 220);
}

/// A page of side 4 from a page of side 16 of stripes, one of 0 and one of 255 in turn.
std::uint8_t mean_of_stripes(Meaning meaning) {
  BakeCall call;
  call.images = {Pixels{16, 16, 1, {}}};
  for (int i = 0; i < 256; ++i) call.images[0].values.push_back(i % 2 == 0 ? 0 : 255);
  call.meaning = meaning;
  call.old_uvs = call.new_uvs = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  call.side = 4;
  EXPECT_EQ(call.run(make_context().get(), "a", {}).texels, 16u);
  const std::vector<std::uint8_t>& values = call.pages.front().values;
  EXPECT_EQ(std::count(values.begin(), values.end(), values[5]), 16);
  return values[5];
}

TEST(Bake, ManyTexelsInOneAreTheirMeanInLightOrInNumbers) {
  EXPECT_NEAR(mean_of_stripes(Meaning::kNumbers), 128, 1);
  EXPECT_NEAR(mean_of_stripes(Meaning::kColours), 188, 1) << "half the light";
}

TEST(Bake, WhatIsTransparentLendsNoColour) {
  // Texels of red that is seen, and of green that is not.
  BakeCall call;
  call.images = {Pixels{2, 1, 4, {255, 0, 0, 255, 0, 255, 0, 0}}};
  call.meaning = Meaning::kTransparent;
  call.old_uvs = call.new_uvs = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  call.side = 1;
  call.run(make_context().get(), "a", {});
  EXPECT_EQ(call.pages.front().values, (std::vector<std::uint8_t>{255, 0, 0, 128}));
}

TEST(Bake, PicturesOf16BitsKeepThem) {
  Pixels image{5, 3, 2, {}};
  image.bytes = 2;
  for (int i = 0; i < 60; ++i) image.values.push_back(static_cast<std::uint8_t>(37 * i));
  const std::optional<Pixels> back = read_image(png_bytes(image));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->bytes, 2u);
  EXPECT_EQ(back->values, image.values);
}

TEST(Bake, PicturesComeBackFromTheirFiles) {
  // Powers of two are how often values occur, so that codes would be longer than they may be.
  std::uint32_t state = 1;
  for (const int components : {1, 2, 3, 4}) {
    for (const int width : {1, 7, 300}) {
      Pixels image{width, 211, components, {}};
      while (image.values.size() < image.row_size() * 211) {
        state = state * 1664525 + 1013904223;
        const auto zeros = static_cast<std::uint8_t>(std::countl_zero(state | 1));
        image.values.insert(image.values.end(), 1 + state / 8 % 4 * (zeros > 2 ? 99 : 0),
                            static_cast<std::uint8_t>(zeros * 8 + state / 64 % (1 + zeros)));
      }
      image.values.resize(image.row_size() * 211);
      const std::optional<Pixels> back =
          read_image(png_bytes(width, 211, components, image.values.data()));
      ASSERT_TRUE(back) << components << " " << width;
      EXPECT_TRUE(back->values == image.values) << components << " " << width;
    }
  }
}

TEST(Bake, AnyNumberOfThreadsGivesTheSameBits) {
  GltfBuilder builder = bent_strip({0, 0, 3, 0, 3, 2, 0, 2, 0, 0, 9, 0, 7, 5, 0, 2});
  add_texture(builder, png_of(64, smooth), "baseColorTexture");
  const BakedModel one(builder, {"--threads", "1"}), three(builder, {"--threads", "3"});
  ASSERT_EQ(one.outcome.exit_code, 0) << one.outcome.err;
  EXPECT_EQ(one.directory.read("out.glb"), three.directory.read("out.glb"));
}

TEST(Bake, TangentsAreThoseOfTheNewUvs) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = builder.vectors3(
      {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0});
  add_texture(builder, png_of(16, smooth), "normalTexture");
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  EXPECT_EQ(model.outcome.err, "");
  const Json& after = model.parts->primitive(0)["attributes"];
  ASSERT_TRUE(after.contains("TANGENT"));
  const Json& accessor = model.parts->json["accessors"][after["TANGENT"].get<std::size_t>()];
  EXPECT_EQ(accessor["type"], "VEC4");
  const std::string bytes = model.parts->view(accessor["bufferView"]);
  for (std::size_t face = 0; face < model.after.polygons.size(); ++face) {
    std::array<Uv, 3> uv = {BakedModel::at(model.after, face, 0, 0),
                            BakedModel::at(model.after, face, 1, 0),
                            BakedModel::at(model.after, face, 0, 1)};
    const double u1 = uv[1][0] - uv[0][0], v1 = uv[0][1] - uv[1][1];
    const double u2 = uv[2][0] - uv[0][0], v2 = uv[0][1] - uv[2][1];
    const std::size_t vertex = model.after.polygons.corners()[3 * face];
    std::array<float, 4> tangent{};
    std::memcpy(tangent.data(), &bytes.at(16 * vertex), 16);
    std::array<double, 3> along{};
    double length = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const auto p = [&](std::size_t k) {
        return model.after.positions[3 * model.after.polygons.corners()[3 * face + k] + d];
      };
      along[d] = v2 * (p(1) - p(0)) - v1 * (p(2) - p(0));
      length += along[d] * along[d];
    }
    EXPECT_GT(u1 * v2 - u2 * v1, 0);
    EXPECT_EQ(tangent[3], 1);
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_NEAR(tangent[d], along[d] / std::sqrt(length), 0.02) << face;
    }
  }
}

TEST(Bake, WithoutNormalsTangentsOfTheOldUvsGo) {
  GltfBuilder builder = rich_square();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive.erase("targets");
  primitive["attributes"].erase("NORMAL");
  add_texture(builder, png_of(16, smooth), "normalTexture");
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  EXPECT_FALSE(model.parts->primitive(0)["attributes"].contains("TANGENT"));
  EXPECT_NE(model.outcome.err.find("does not keep tangents"), std::string::npos)
      << model.outcome.err;
}

// The numbers of an extension that nobody here knows may name a texture; those of a lamp do not.
TEST(Bake, TheNumbersOfALampKeepNoTexture) {
  for (const auto& [name, left] : {std::pair("KHR_lights_punctual", 1u), {"NOBODY_knows", 2u}}) {
    GltfBuilder builder = bent_strip(kTwoHalves);
    add_texture(builder, png_of(16, smooth), "baseColorTexture");
    builder.json["extensions"] = {{name, {{"lights", {{{"color", {0, 0, 0}}}}}}}};
    const BakedModel model(builder);
    ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
    EXPECT_EQ(model.parts->json["images"].size(), left) << name;
  }
}

TEST(Bake, MissingImagesAreLeftOutAndNamed) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kWoodenSquare);
  directory.file("in.mtl", "newmtl wood\nmap_Kd paint.png\nmap_Bump bump.png\n");
  const std::string out = directory.path("out.obj");
  const Outcome none = run({"unwrap", in, out, "--bake", "--resolution", "64"});
  EXPECT_EQ(none.exit_code, kExitUnusable);
  EXPECT_NE(none.err.find("paint.png"), std::string::npos) << none.err;
  directory.file("paint.png", png_of(16, smooth));
  const Outcome one = run({"unwrap", in, out, "--bake", "--resolution", "64"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_NE(one.err.find("bump.png (map_Bump of material 'wood') is missing"), std::string::npos)
      << one.err;
  const std::string made = directory.read("out.mtl");
  EXPECT_NE(made.find("map_Kd -clamp on out_wood_map_kd.png\n"), std::string::npos) << made;
  EXPECT_NE(made.find("map_Bump bump.png\n"), std::string::npos) << made;

  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, png_of(16, smooth), "baseColorTexture");
  add_texture(builder, png_of(16, smooth), "emissiveTexture");
  builder.json["images"][1] = {{"uri", "gone.png"}};
  const std::string model = directory.file("in.gltf", builder.text());
  const Outcome gltf =
      run({"unwrap", model, directory.path("o.gltf"), "--bake", "--resolution", "64"});
  ASSERT_EQ(gltf.exit_code, 0) << gltf.err;
  EXPECT_NE(gltf.err.find("gone.png"), std::string::npos) << gltf.err;
  const Json json = Json::parse(directory.read("o.gltf"));
  EXPECT_EQ(json["images"][1]["uri"], "gone.png");
}

TEST(Bake, FormatsThatCannotBeReadAreNamed) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, "RIFF\1\1\1\1WEBPVP8 ", "baseColorTexture");
  const BakedModel model(builder);
  EXPECT_EQ(model.outcome.exit_code, kExitUnusable);
  EXPECT_NE(model.outcome.err.find("images[0] (baseColorTexture of materials[0]) is "),
            std::string::npos)
      << model.outcome.err;
  EXPECT_NE(model.outcome.err.find("WebP"), std::string::npos) << model.outcome.err;
}

TEST(Bake, SeveralPagesAreRefused) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, png_of(16, smooth), "baseColorTexture");
  const BakedModel model(builder, {"--texels-per-unit", "200", "--hard-angle", "60"});
  EXPECT_EQ(model.outcome.exit_code, kExitUnusable);
  EXPECT_NE(model.outcome.err.find("a material has a texture of one"), std::string::npos)
      << model.outcome.err;
  const BakedModel rows(builder, {"--pack", "none"});
  EXPECT_EQ(rows.outcome.exit_code, kExitUnusable);
}

TEST(Bake, TheFilesOfAGltfLieBesideIt) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, png_of(16, smooth), "baseColorTexture");
  builder.json["materials"][0]["name"] = "../a b";
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.gltf", builder.text()), out = directory.path("o.gltf");
  const Outcome outcome = run({"unwrap", in, out, "--bake", "--resolution", "64"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(read_image(directory.read("o____a_b_baseColor.png")));
  const Json json = Json::parse(directory.read("o.gltf"));
  EXPECT_EQ(json["images"][0]["uri"], "o____a_b_baseColor.png");
  const std::string again = directory.path("again.gltf");
  EXPECT_EQ(run({"unwrap", out, again, "--bake", "--resolution", "64"}).exit_code, 0);
}

TEST(Bake, AnObjBecomesGltfWithItsMaterials) {
  const TemporaryDirectory directory;
  directory.file("a.mtl",
                 "newmtl wood\nKd 0.8 0.2 0.1\nPr 0.5\nmap_Kd wood.png\n"
                 "newmtl glass\nKd 0 0 1\nd 0.25\nmap_Ns wood.png\n");
  directory.file("wood.png", png_of(16, smooth));
  const std::string in =
      directory.file("a.obj",
                     "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n"
                     "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3 4/4\n"
                     "usemtl glass\nf 2/1 5/2 6/3 3/4\n");
  const Outcome outcome =
      run({"unwrap", in, directory.path("out.glb"), "--bake", "--resolution", "64"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("map_Ns of material 'glass'"), std::string::npos) << outcome.err;
  const Parts parts(directory.read("out.glb"));
  ASSERT_EQ(parts.json["materials"].size(), 2u);
  const Json& wood = parts.json["materials"][0]["pbrMetallicRoughness"];
  EXPECT_EQ(wood["baseColorFactor"], Json({1.0, 1.0, 1.0, 1.0}));
  EXPECT_EQ(wood["roughnessFactor"], 0.5);
  EXPECT_TRUE(wood.contains("baseColorTexture"));
  const Json& glass = parts.json["materials"][1];
  EXPECT_EQ(glass["alphaMode"], "BLEND");
  EXPECT_EQ(glass["pbrMetallicRoughness"]["baseColorFactor"], Json({0.0, 0.0, 1.0, 0.25}));
  EXPECT_EQ(parts.json["meshes"][0]["primitives"].size(), 2u);
  EXPECT_NE(run({"unwrap", in, directory.path("o.glb"), "--write-seams", directory.path("s.txt")})
                .err.find("--write-seams"),
            std::string::npos);
}

TEST(Bake, FacesWithoutUvsAreBesideThoseWithTextures) {
  const TemporaryDirectory directory;
  directory.file("a.mtl", "newmtl wood\nmap_Kd wood.png\nnewmtl gr\xfcn\nKd 0 1 0\n");
  directory.file("wood.png", png_of(16, smooth));
  const std::string in = directory.file(
      "a.obj",
      "mtllib a.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3 4/4\n"
      "usemtl gr\xfcn\nf 2 5 6\nusemtl other\nf 2 6 3\n");
  const std::string glb = directory.path("out.glb");
  const Outcome outcome = run({"unwrap", in, glb, "--bake", "--resolution", "64"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("gone.mtl"), std::string::npos) << outcome.err;
  const Parts parts(directory.read("out.glb"));
  ASSERT_EQ(parts.json["materials"].size(), 3u);
  EXPECT_TRUE(parts.json["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
  EXPECT_EQ(parts.json["materials"][1]["name"], "gr\xc3\xbcn");
  EXPECT_EQ(parts.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"],
            Json({0.0, 1.0, 0.0, 1.0}));
  EXPECT_EQ(parts.json["materials"][2]["name"], "other");
  EXPECT_EQ(parts.json["meshes"][0]["primitives"].size(), 3u);
}

TEST(Bake, AnImageOutOfReachIsMissing) {
  const TemporaryDirectory directory;
  directory.file("a.mtl",
                 "newmtl wood\nmap_Kd wood.png\nnewmtl far\nmap_Kd C:\\textures\\far.png\n");
  directory.file("wood.png", png_of(16, smooth));
  const std::string in =
      directory.file("a.obj",
                     "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                     "vt 0 1\nusemtl wood\nf 1/1 2/2 3/3\nusemtl far\nf 1/1 3/3 4/4\n");
  const Outcome outcome =
      run({"unwrap", in, directory.path("out.obj"), "--bake", "--resolution", "64"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("far.png"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("its name stays"), std::string::npos) << outcome.err;
}

TEST(Bake, LabelsOfObjCutWhatBecomesGltf) {
  const TemporaryDirectory directory;
  const std::string in =
      directory.file("a.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                     "g a\nusemtl x\nf 1 2 3 4\ng b\nf 2 6 3\nusemtl y\nf 2 5 6\n");
  const auto charts = [&](const char* output, const std::string& labels) {
    const std::string report = directory.path("r.json");
    const Outcome outcome =
        run({"unwrap", in, directory.path(output), "--labels", labels, "--report", report});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(directory.read("r.json"))["charts"];
  };
  for (const char* labels : {"groups", "materials"}) {
    EXPECT_EQ(charts("o.obj", labels), 2) << labels;
    EXPECT_EQ(charts("o.glb", labels), 2) << labels;
  }
}

TEST(Bake, MapsOfMtlAreChannelsOfGltf) {
  const TemporaryDirectory directory;
  directory.file("a.mtl",
                 "newmtl leaf\nPr 0.5\nmap_Kd c.png\nmap_Pr r.png\nmap_Pm -imfchan b m.png\n"
                 "map_d d.png\nmap_Ke c.png\nnorm n.png\n");
  const auto plain = [](double r, double g, double b) {
    return [=](double, double) { return Texel{r, g, b}; };
  };
  directory.file("c.png", png_of(16, plain(200, 100, 50)));
  directory.file("r.png", png_of(8, plain(90, 90, 90)));
  directory.file("m.png", png_of(4, plain(1, 2, 150)));
  directory.file("n.png", png_of(4, plain(128, 128, 255)));
  const auto half = [](double x, double) { return x < 0.5 ? Texel{} : Texel{255, 255, 255}; };
  directory.file("d.png", png_of(16, half));
  const std::string in =
      directory.file("a.obj",
                     "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                     "vt 0 1\nusemtl leaf\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  const Outcome outcome = run({"unwrap", in, directory.path("out.glb")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("map_"), std::string::npos) << outcome.err;
  const Parts parts(directory.read("out.glb"));
  const Json& material = parts.json["materials"][0];
  const Json& pbr = material["pbrMetallicRoughness"];
  const auto texel = [&](const Json& info, std::size_t place) {
    const Json& texture = parts.json["textures"][info["index"].get<std::size_t>()];
    const Json& image = parts.json["images"][texture["source"].get<std::size_t>()];
    const Pixels pixels = *read_image(parts.view(image["bufferView"]));
    const auto width = static_cast<std::size_t>(pixels.components);
    const auto first = pixels.values.begin() + static_cast<std::ptrdiff_t>(width * place);
    return std::vector<std::uint8_t>(first, first + static_cast<std::ptrdiff_t>(width));
  };
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(texel(pbr["metallicRoughnessTexture"], 5), (Bytes{255, 90, 150}));
  EXPECT_EQ(texel(pbr["baseColorTexture"], 2), (Bytes{200, 100, 50, 0}));
  EXPECT_EQ(texel(pbr["baseColorTexture"], 14), (Bytes{200, 100, 50, 255}));
  EXPECT_EQ(texel(material["emissiveTexture"], 0), (Bytes{200, 100, 50}));
  EXPECT_EQ(pbr["roughnessFactor"], 1.0);
  EXPECT_EQ(pbr["metallicFactor"], 1.0);
  EXPECT_EQ(material["alphaMode"], "MASK");
  EXPECT_TRUE(material.contains("normalTexture"));
}

TEST(Bake, AnObjGetsALibraryAndImagesOfItsOwn) {
  const TemporaryDirectory directory;
  const std::string library =
      "newmtl wood\nKd 1 1 1\nmap_Kd -s 2 2 1 paint.png\nmap_Bump -bm 0.5 bump.png\n";
  const std::string in = directory.file("in.obj", kWoodenSquare), out = directory.path("out.obj");
  directory.file("in.mtl", library);
  directory.file("paint.png", png_of(64, smooth));
  directory.file("bump.png", png_of(64, [](double, double) { return Texel{128, 128, 255}; }));
  const Outcome plain = run({"unwrap", in, out});
  EXPECT_NE(plain.err.find("2 textures (map_Kd of material 'wood', map_Bump of material 'wood')"),
            std::string::npos)
      << plain.err;
  EXPECT_NE(plain.err.find("--bake"), std::string::npos);
  const Outcome outcome = run({"unwrap", in, out, "--bake", "--resolution", "128"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("map_Kd"), std::string::npos) << outcome.err;
  EXPECT_NE(directory.read("out.obj").find("mtllib out.mtl\n"), std::string::npos);
  const std::string made = directory.read("out.mtl");
  EXPECT_NE(made.find("map_Kd -clamp on out_wood_map_kd.png\n"), std::string::npos) << made;
  EXPECT_NE(made.find("map_Bump -bm 0.5 -clamp on out_wood_map_bump.png\n"), std::string::npos);
  EXPECT_NE(made.find("Kd 1 1 1\n"), std::string::npos);
  EXPECT_EQ(read_image(directory.read("out_wood_map_kd.png"))->width, 128);
  EXPECT_EQ(directory.read("in.mtl"), library);
  // In place the library is another file than the one that was read.
  ASSERT_EQ(run({"unwrap", in, in, "--bake", "--resolution", "64"}).exit_code, 0);
  EXPECT_EQ(directory.read("in.mtl"), library);
  EXPECT_NE(directory.read("in.obj").find("mtllib in-1.mtl\n"), std::string::npos);
}

}  // namespace
}  // namespace beltrami::cli
