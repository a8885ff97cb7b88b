// beltrami unwrap --bake --merge-materials, end to end.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "baked_model.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

/// The strip of two squares, each with a material of its own.
GltfBuilder two_materials(std::initializer_list<float> uvs) {
  GltfBuilder builder = bent_strip(uvs);
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[0]["indices"] = builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3});
  primitives[1]["indices"] = builder.indices<std::uint8_t>({4, 5, 6, 4, 6, 7});
  primitives[1]["material"] = 1;
  builder.json["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  return builder;
}

const std::initializer_list<float> kWholeTwice = {0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0, 1};

double linear_of(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

TEST(MergeMaterials, ATextureAndAColourBecomeOnePicture) {
  GltfBuilder builder = two_materials(kWholeTwice);
  add_texture(builder, png_of(128, smooth), "baseColorTexture");
  builder.json["materials"][1]["pbrMetallicRoughness"] = {
      {"baseColorFactor", {0.5, 0.25, 1.0, 1.0}}, {"metallicFactor", 0.0}};
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Json& json = model.parts->json;
  ASSERT_EQ(json["materials"].size(), 1u);
  ASSERT_EQ(json["meshes"][0]["primitives"].size(), 1u) << "their vertices are the same";
  const Json& pbr = json["materials"][0]["pbrMetallicRoughness"];
  EXPECT_FALSE(pbr.contains("baseColorFactor"));
  const Pixels colours = model.base_colour(), others = model.image(pbr["metallicRoughnessTexture"]);
  const Pixels before = *read_image(png_of(128, smooth));
  model.visit([&](std::size_t face, const Uv& old_uv, const Uv& new_uv) {
    const Texel now = read_at(colours, new_uv), metal = read_at(others, new_uv);
    const Texel plain = {255 * srgb_of(0.5), 255 * srgb_of(0.25), 255};
    const Texel wanted = face < 2 ? read_at(before, old_uv) : plain;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(now[k], wanted[k], 8) << face;
    EXPECT_NEAR(metal[1], 255, 1);
    EXPECT_NEAR(metal[2], face < 2 ? 255 : 0, 1) << face;
  });
}

TEST(MergeMaterials, FactorsOfATextureAreBakedInLinearLight) {
  GltfBuilder builder = two_materials(kWholeTwice);
  add_texture(builder,
              png_of(8,
                     [](double, double) {
                       return Texel{200, 100, 50};
                     }),
              "baseColorTexture");
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 1.0, 1.0, 1.0};
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels colours = model.base_colour();
  model.visit([&](std::size_t face, const Uv&, const Uv& new_uv) {
    const Texel now = read_at(colours, new_uv);
    const double half = 255 * srgb_of(0.5 * linear_of(200.0 / 255));
    EXPECT_NEAR(now[0], face < 2 ? half : 255, 1) << face;
    EXPECT_NEAR(now[1], face < 2 ? 100 : 255, 1) << face;
  });
}

TEST(MergeMaterials, FactorsThatAllHaveStay) {
  GltfBuilder builder = two_materials(kWholeTwice);
  for (Json& material : builder.json["materials"]) {
    material["pbrMetallicRoughness"] = {{"roughnessFactor", 0.25}, {"metallicFactor", 0.0}};
    material["emissiveFactor"] = {1.0, 0.5, 0.0};
  }
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Json& json = model.parts->json;
  EXPECT_FALSE(json.contains("images"));
  ASSERT_EQ(json["materials"].size(), 1u);
  EXPECT_EQ(json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"], 0.25);
  EXPECT_EQ(json["materials"][0]["emissiveFactor"], Json({1.0, 0.5, 0.0}));
}

TEST(MergeMaterials, WaysOfReadingMayDiffer) {
  // The first repeats, the second is mirrored.
  GltfBuilder builder = two_materials({0, 0, 2, 0, 2, 2, 0, 2, -1, 0, 1, 0, 1, 2, -1, 2});
  add_texture(builder, png_of(64, smooth), "baseColorTexture");
  add_texture(builder, png_of(64, smooth), "emissiveTexture", {{"wrapS", 33648}, {"wrapT", 33071}});
  Json& materials = builder.json["materials"];
  materials[1]["pbrMetallicRoughness"]["baseColorTexture"] = materials[0]["emissiveTexture"];
  materials[0].erase("emissiveTexture");
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Pixels colours = model.base_colour(), before = *read_image(png_of(64, smooth));
  const double found = model.psnr(colours, [&](const Uv&) { return Texel{}; });
  EXPECT_LT(found, 20);
  double sum = 0;
  int count = 0;
  model.visit([&](std::size_t face, const Uv& old_uv, const Uv& new_uv) {
    Uv uv = old_uv;
    if (face >= 2) {
      uv[0] = std::abs(uv[0] - 2 * std::round(uv[0] / 2));
      const double edge = 0.5 / 64;
      uv[0] = std::min(std::max(uv[0], edge), 1 - edge);
      uv[1] = std::min(std::max(uv[1], edge), 1 - edge);
    }
    const Texel now = read_at(colours, new_uv), was = read_at(before, uv);
    for (std::size_t k = 0; k < 3; ++k) sum += (now[k] - was[k]) * (now[k] - was[k]);
    count += 3;
  });
  EXPECT_GE(10 * std::log10(255 * 255 / (sum / count)), 34);
}

TEST(MergeMaterials, OcclusionStaysWithRoughness) {
  GltfBuilder builder = two_materials(kWholeTwice);
  add_texture(builder,
              png_of(8,
                     [](double, double) {
                       return Texel{100, 150, 200};
                     }),
              "occlusionTexture");
  Json& materials = builder.json["materials"];
  materials[0]["pbrMetallicRoughness"] = {
      {"metallicRoughnessTexture", materials[0]["occlusionTexture"]}};
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Json& json = model.parts->json;
  ASSERT_EQ(json["images"].size(), 1u);
  const Json& material = json["materials"][0];
  EXPECT_EQ(material["occlusionTexture"]["index"],
            material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"]);
  const Pixels image = model.image(material["occlusionTexture"]);
  model.visit([&](std::size_t face, const Uv&, const Uv& new_uv) {
    const Texel now = read_at(image, new_uv);
    const Texel wanted = face < 2 ? Texel{100, 150, 200} : Texel{255, 255, 255};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(now[k], wanted[k], 1) << face;
  });
}

TEST(MergeMaterials, WhatCannotBeBakedKeepsMaterialsApart) {
  GltfBuilder builder = two_materials(kWholeTwice);
  add_texture(builder, png_of(8, smooth), "baseColorTexture");
  builder.json["materials"][1]["alphaMode"] = "BLEND";
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  EXPECT_NE(model.outcome.err.find("'a' and 'b' differ in alphaMode"), std::string::npos)
      << model.outcome.err;
  const Json& json = model.parts->json;
  ASSERT_EQ(json["materials"].size(), 2u);
  EXPECT_EQ(json["images"].size(), 1u) << "they share their pictures";
  EXPECT_EQ(model.base_colour().components, 4);
}

TEST(MergeMaterials, WhatMayHaveTheirNumbersKeepsThem) {
  GltfBuilder builder = two_materials(kWholeTwice);
  builder.json["extras"] = {{"favourite", 1}};
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Json& materials = model.parts->json["materials"];
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_EQ(materials[0], materials[1]);
}

TEST(MergeMaterials, WithoutMaterialsThereIsNothingToDo) {
  GltfBuilder builder = bent_strip(kTwoHalves);
  builder.json["meshes"][0]["primitives"][0].erase("material");
  const BakedModel model(builder, {"--merge-materials"});
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  EXPECT_FALSE(model.parts->json.contains("materials"));
}

TEST(MergeMaterials, VariantsAndOtherFormatsAreRefused) {
  GltfBuilder builder = two_materials(kWholeTwice);
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
      {"mappings", Json::array({{{"material", 1}, {"variants", {0}}}})}};
  const BakedModel model(builder, {"--merge-materials"});
  EXPECT_EQ(model.outcome.exit_code, kExitUnusable);
  EXPECT_NE(model.outcome.err.find("variants"), std::string::npos) << model.outcome.err;
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.glb", two_materials(kWholeTwice).glb());
  const Outcome outcome = run({"unwrap", in, directory.path("out.glb"), "--merge-materials"});
  EXPECT_EQ(outcome.exit_code, kExitUnusable);
  EXPECT_NE(outcome.err.find("add --bake"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace beltrami::cli
