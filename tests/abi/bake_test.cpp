// Baking through the C ABI: what comes back, and what is refused.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "abi/host.h"

namespace beltrami::host {
namespace {

constexpr std::uint64_t kSide = 32;

/// A square of two triangles that shows an image of noise, and room for a page.
struct Square {
  std::vector<double> uvs = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  std::vector<std::uint8_t> noise = std::vector<std::uint8_t>(3 * kSide * kSide);
  std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(3 * kSide * kSide, 7);
  beltrami_image image{};
  beltrami_bake_job job = sized<beltrami_bake_job>();
  beltrami_baked out = sized<beltrami_baked>();
  Context context = create();

  Square() {
    std::uint32_t state = 1;
    for (std::uint8_t& value : noise) {
      state = state * 1664525 + 1013904223;
      value = static_cast<std::uint8_t>(state >> 24);
    }
    image = {noise.data(), kSide, kSide, 0, BELTRAMI_U8, 3};
    job.images = &image;
    job.image_count = 1;
    job.face_count = 2;
    job.new_uvs = job.old_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
    job.resolution = kSide;
    job.page_count = 1;
    out.pixels = pixels.data();
  }
  Square(const Square&) = delete;
  Square& operator=(const Square&) = delete;

  beltrami_status bake(beltrami_progress progress = nullptr) {
    return beltrami_bake(context.get(), &job, &out, progress, nullptr);
  }
};

TEST(Bake, TheSameUvsGiveTheSameImage) {
  Square square;
  for (const std::int32_t pixels :
       {BELTRAMI_PIXELS_LINEAR, BELTRAMI_PIXELS_SRGB, BELTRAMI_PIXELS_SRGB_ALPHA}) {
    square.job.pixels = pixels;
    ASSERT_EQ(square.bake(), BELTRAMI_OK) << message(square.context);
    EXPECT_EQ(square.pixels, square.noise) << pixels;
    EXPECT_EQ(square.out.texels, kSide * kSide);
    EXPECT_EQ(square.out.without_source, 0u);
    EXPECT_NEAR(square.out.old_texels, 1, 1e-12);
  }
}

TEST(Bake, WhatLiesFarBeyondAllTexelsShowsNone) {
  for (const double far : {1e15, 1e100, 1.7e308}) {
    for (const bool nearest : {false, true}) {
      Square square;
      const std::vector<double> old(square.uvs.size(), far);
      square.job.old_uvs = {old.data(), 0, BELTRAMI_F64, 0};
      if (nearest) square.job.filter = BELTRAMI_FILTER_NEAREST;
      const beltrami_status status = square.bake();
      EXPECT_EQ(status == BELTRAMI_OK, far == 1e15) << far << message(square.context);
    }
  }
}

TEST(Bake, RowsMayBeApart) {
  Square square;
  std::vector<std::uint8_t> wide(100 * kSide, 9);
  square.out.pixels = wide.data();
  square.out.stride = 100;
  ASSERT_EQ(square.bake(), BELTRAMI_OK);
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t i = 0; i < 100; ++i) {
      const std::uint8_t expected = i < 3 * kSide ? square.noise[3 * kSide * row + i] : 9;
      ASSERT_EQ(wide[100 * row + i], expected);
    }
  }
}

TEST(Bake, AnyNumberOfThreadsGivesTheSameBits) {
  Square square;
  for (double& uv : square.uvs) uv *= 3.3;
  std::vector<double> turned = {0.9, 0.1, 0.8, 0.9, 0.1, 0.8, 0.9, 0.1, 0.1, 0.8, 0.2, 0.15};
  square.job.new_uvs.data = turned.data();
  square.job.gutter = std::numeric_limits<std::uint64_t>::max();
  ASSERT_EQ(square.bake(), BELTRAMI_OK);
  const std::vector<std::uint8_t> one = square.pixels;
  for (const int threads : {2, 5}) {
    ASSERT_EQ(beltrami_set_int(square.context.get(), BELTRAMI_OPTION_THREADS, threads),
              BELTRAMI_OK);
    ASSERT_EQ(square.bake(), BELTRAMI_OK);
    EXPECT_EQ(square.pixels, one);
  }
}

TEST(Bake, MostTexelsNeedASource) {
  Square square;
  std::vector<double> nowhere(12, std::numeric_limits<double>::quiet_NaN());
  square.job.old_uvs.data = nowhere.data();
  EXPECT_EQ(square.bake(), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(square.context).find("1024 of 1024 texels have no source"), std::string::npos);
  EXPECT_EQ(square.out.without_source, kSide * kSide);
}

TEST(Bake, ACallbackAndANumberEndIt) {
  Square square;
  EXPECT_EQ(square.bake([](void*, double, const char*) -> std::int32_t { return 1; }),
            BELTRAMI_E_CANCELLED);
  const std::int32_t number = 1;
  square.job.cancel = &number;
  EXPECT_EQ(square.bake(), BELTRAMI_E_CANCELLED);
}

TEST(Bake, WhatIsWrongIsSaid) {
  const auto refused = [](const auto& change, beltrami_status status, const char* words) {
    Square square;
    change(square);
    EXPECT_EQ(square.bake(), status) << words;
    EXPECT_NE(message(square.context).find(words), std::string::npos) << message(square.context);
  };
  const beltrami_status argument = BELTRAMI_E_INVALID_ARGUMENT;
  refused([](Square& s) { s.job.struct_size = 8; }, argument, "struct_size");
  refused([](Square& s) { s.job.flags = 1; }, argument, "flags");
  refused([](Square& s) { s.out.pixels = nullptr; }, argument, "NULL");
  refused([](Square& s) { s.out.stride = 5; }, argument, "stride");
  refused([](Square& s) { s.job.images = nullptr; }, argument, "images");
  refused([](Square& s) { s.image.channels = 5; }, argument, "channels");
  refused([](Square& s) { s.image.type = BELTRAMI_U32; }, argument, "BELTRAMI_U16");
  refused([](Square& s) { s.image.width = 0; }, argument, "width");
  refused([](Square& s) { s.job.wrap_u = 3; }, argument, "wrap_u");
  refused([](Square& s) { s.job.resolution = 40000; }, argument, "resolution");
  refused([](Square& s) { s.job.page_count = 0; }, argument, "page_count");
  refused([](Square& s) { s.job.pixels = BELTRAMI_PIXELS_NORMALS; }, argument, "positions");
  refused([](Square& s) { s.job.face_count = 0; }, BELTRAMI_E_EMPTY, "no faces");
  refused([](Square& s) { s.uvs[6] = std::numeric_limits<double>::infinity(); },
          BELTRAMI_E_NON_FINITE, "corner 3");
}

TEST(Bake, FacesOnNoPageAreLeftOut) {
  Square square;
  const std::array<std::uint32_t, 2> pages = {0, 0xFFFFFFFF};
  square.job.new_pages = {pages.data(), 0, BELTRAMI_U32, 0};
  std::vector<std::uint8_t> masks(kSide * kSide, 9);
  square.out.masks = masks.data();
  ASSERT_EQ(square.bake(), BELTRAMI_OK);
  const auto covered = std::count(masks.begin(), masks.end(), std::uint8_t{BELTRAMI_TEXEL_COVERED});
  EXPECT_EQ(static_cast<std::uint64_t>(covered), square.out.texels);
  EXPECT_EQ(square.out.texels, kSide * (kSide + 1) / 2);
}

}  // namespace
}  // namespace beltrami::host
