// Images for new UVs, from C++.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace beltrami::host {
namespace {

/// A square that shows a picture of 2 x 2 texels.
struct Shown {
  std::array<std::uint16_t, 4> texels = {100, 200, 300, 65535};
  std::array<double, 12> uvs = {0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1};
  beltrami_image image{texels.data(), 2, 2, 0, BELTRAMI_U16, 1};
  beltrami_bake_job job{};

  Shown() {
    job.images = &image;
    job.image_count = 1;
    job.face_count = 2;
    job.new_uvs = job.old_uvs = {uvs.data(), 0, BELTRAMI_F64, 0};
    job.resolution = 2;
    job.page_count = 1;
  }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
};

TEST(CppBake, GivesPagesOfTheTypeOfTheImages) {
  const Shown shown;
  const Baked<std::uint16_t> baked = Context().bake<std::uint16_t>(shown.job);
  EXPECT_EQ(baked.pixels, std::vector<std::uint16_t>(shown.texels.begin(), shown.texels.end()));
  EXPECT_EQ(baked.masks, std::vector<std::uint8_t>(4, BELTRAMI_TEXEL_COVERED));
  EXPECT_EQ(baked.texels, 4u);
  EXPECT_EQ(baked.without_source, 0u);
}

TEST(CppBake, RefusesWhatDoesNotFit) {
  Shown shown;
  Context context;
  EXPECT_EQ(context.try_bake<std::uint8_t>(shown.job).status(), Status::kInvalidArgument);
  shown.job.resolution = 40000;
  EXPECT_EQ(context.try_bake<std::uint16_t>(shown.job).status(), Status::kInvalidArgument);
  shown.job.images = nullptr;
  EXPECT_EQ(context.try_bake<std::uint16_t>(shown.job).status(), Status::kInvalidArgument);
}

TEST(CppBake, ACallableEndsIt) {
  const Shown shown;
  const auto end = [](double, const char*) { return false; };
  EXPECT_EQ(Context().try_bake<std::uint16_t>(shown.job, end).status(), Status::kCancelled);
}

}  // namespace
}  // namespace beltrami::host
