// Formats of pictures beside PNG and JPEG.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "baked_model.h"
#include "gltf_builder.h"
#include "gltf_parts.h"
#include "picture/light.h"
#include "picture/stb_in_one_place.h"
#include "picture/webp.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

/// 8 x 8 texels of WebP without loss: 30 times the column, 30 times the row, 77, and an alpha of
/// 255 above and 100 below.
std::string small_webp() {
  constexpr std::string_view kDigits =
      "5249464634000000574542505650384c270000002f07c00110993244f43f3611d1ff8041b69146327fd0bbfb4718"
      "8f699ab20940240b906fb2883700";
  std::string bytes;
  for (std::size_t i = 0; i < kDigits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(kDigits.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

Pixels of_floats(int width, int height, int components, const std::vector<float>& values) {
  Pixels image{width, height, components, {}, sizeof(float)};
  image.values.resize(sizeof(float) * values.size());
  std::memcpy(image.values.data(), values.data(), image.values.size());
  return image;
}

std::vector<float> floats_of(const Pixels& image) {
  std::vector<float> values(image.values.size() / sizeof(float));
  std::memcpy(values.data(), image.values.data(), image.values.size());
  return values;
}

TEST(PictureFormats, WebpIsReadWithItsAlpha) {
  if (!has_webp()) GTEST_SKIP() << "built without libwebp";
  const std::optional<Pixels> image = read_image(small_webp());
  ASSERT_TRUE(image);
  ASSERT_EQ(image->components, 4);
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(image->values[4 * i], 30 * (i % 8));
    EXPECT_EQ(image->values[4 * i + 1], 30 * (i / 8));
    EXPECT_EQ(image->values[4 * i + 3], i < 32 ? 255 : 100);
  }
}

TEST(PictureFormats, DamagedWebpIsRefused) {
  if (!has_webp()) GTEST_SKIP() << "built without libwebp";
  const std::string whole = small_webp();
  for (std::size_t size = 0; size < whole.size() - 8; ++size) {
    EXPECT_FALSE(read_image(whole.substr(0, size))) << size;
  }
}

TEST(PictureFormats, AWebpTextureOfGltfBecomesPng) {
  if (!has_webp()) GTEST_SKIP() << "built without libwebp";
  GltfBuilder builder = bent_strip(kTwoHalves);
  add_texture(builder, small_webp(), "baseColorTexture");
  Json& json = builder.json;
  json["images"][0]["mimeType"] = "image/webp";
  json["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  json["extensionsUsed"] = json["extensionsRequired"] = {"EXT_texture_webp"};
  const BakedModel model(builder);
  ASSERT_EQ(model.outcome.exit_code, 0) << model.outcome.err;
  const Json& out = model.parts->json;
  EXPECT_EQ(out["images"][0]["mimeType"], "image/png");
  EXPECT_FALSE(out.contains("extensionsUsed"));
  EXPECT_FALSE(out.contains("extensionsRequired"));
  EXPECT_EQ(model.base_colour().components, 4);
}

TEST(PictureFormats, HdrKeepsLightToOnePercent) {
  const std::vector<float> values = {0.5f, 1.0f, 40.0f, 3.0f, 0.25f, 2.0f};
  const std::optional<Pixels> back = read_light(hdr_bytes(of_floats(2, 1, 3, values)));
  ASSERT_TRUE(back);
  const std::vector<float> found = floats_of(*back);
  for (std::size_t i = 0; i < 6; ++i) {
    const float most = values[i < 3 ? 2 : 3];
    EXPECT_NEAR(found[i], values[i], 0.01f * most);
  }
  EXPECT_FALSE(is_image(hdr_bytes(of_floats(2, 1, 3, values)))) << "materials have none";
}

TEST(PictureFormats, ExrKeepsEveryBit) {
  if (!has_exr()) GTEST_SKIP() << "built without OpenEXR";
  for (const int components : {1, 2, 3, 4}) {
    std::vector<float> values;
    for (int i = 0; i < 5 * 3 * components; ++i) {
      values.push_back(0.1f * static_cast<float>(i) - 1);
    }
    const Pixels image = of_floats(5, 3, components, values);
    const std::string bytes = light_bytes(image, LightFormat::kExr);
    const std::optional<Pixels> back = read_light(bytes);
    ASSERT_TRUE(back) << components;
    EXPECT_EQ(floats_of(*back), values) << components;
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      EXPECT_FALSE(read_light(std::string_view(bytes).substr(0, size))) << size;
    }
  }
}

TEST(PictureFormats, HalfAsManyBitsStayAsMany) {
  if (!has_exr()) GTEST_SKIP() << "built without OpenEXR";
  Pixels image = of_floats(2, 2, 3, {0, 0.5f, 1, 2, 4, 8, 16, 32, 64, -1, -2, 1024});
  image.half = true;
  const std::optional<Pixels> back = read_light(light_bytes(image, LightFormat::kExr));
  ASSERT_TRUE(back);
  EXPECT_TRUE(back->half);
  EXPECT_EQ(floats_of(*back), floats_of(image));
}

TEST(PictureFormats, TransferCarriesLight) {
  const TemporaryDirectory directory;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  const std::string from = directory.file("a.obj", obj + "f 1/1 2/2 3/3 4/4\n");
  const std::string to = directory.file("b.obj", obj + "f 1/2 2/3 3/4 4/1\n");
  std::vector<float> values(16 * 16 * 3, 7.5f);
  const std::string texture = directory.file("t.hdr", hdr_bytes(of_floats(16, 16, 3, values)));
  const Outcome outcome = run({"transfer", from, to, texture, directory.path("o.hdr")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::optional<Pixels> made = read_light(directory.read("o.hdr"));
  ASSERT_TRUE(made);
  for (const float value : floats_of(*made)) EXPECT_NEAR(value, 7.5f, 0.05f);
  const Outcome wrong = run({"transfer", from, to, texture, directory.path("o.png")});
  EXPECT_EQ(wrong.exit_code, kExitUnusable);
  EXPECT_NE(wrong.err.find("use the extension .exr or .hdr"), std::string::npos) << wrong.err;
  if (!has_exr()) return;
  EXPECT_EQ(run({"transfer", from, to, texture, directory.path("o.exr")}).exit_code, 0);
  EXPECT_TRUE(read_light(directory.read("o.exr")));
}

}  // namespace
}  // namespace beltrami::cli
