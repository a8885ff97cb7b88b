// Baking from another surface along rays, and what of the sky is seen.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "abi/host.h"

namespace beltrami::host {
namespace {

constexpr std::uint64_t kSide = 32;
using Place = std::array<double, 3>;

/// Corners of triangles in space, with the UVs of each.
struct Corners {
  std::vector<double> places, uvs;

  /// Two triangles for a patch of a surface over a square of UVs.
  template <class Surface>
  void add(const Surface& surface, double u0, double v0, double u1, double v1) {
    const std::array<std::array<double, 2>, 6> square = {
        {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v0}, {u1, v1}, {u0, v1}}};
    for (const auto& [u, v] : square) {
      const Place place = surface(u, v);
      places.insert(places.end(), place.begin(), place.end());
      uvs.insert(uvs.end(), {u, v});
    }
  }
  /// A grid over the unit square.
  template <class Surface>
  void add_grid(const Surface& surface, int count) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        add(surface, double(i) / count, double(j) / count, double(i + 1) / count,
            double(j + 1) / count);
      }
    }
  }
};

beltrami_buffer numbers(const std::vector<double>& values) {
  return {values.empty() ? nullptr : values.data(), 0, BELTRAMI_F64, 0};
}

/// A page of numbers for the UVs of a surface.
struct Job {
  Corners coarse, fine;
  std::vector<double> normals;
  std::vector<float> image = {0, 1, 0, 1};  ///< u, as it is between the middles of two texels
  std::vector<float> pixels = std::vector<float>(kSide * kSide, -1);
  double cage = 0;
  std::uint64_t rays = 0;
  std::uint64_t texels = 0, without_source = 0;
  std::string said;

  beltrami_status bake(std::int64_t threads = 1) {
    const Context context = create();
    EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, threads), BELTRAMI_OK);
    const beltrami_image view = {image.data(), 2, 2, 0, BELTRAMI_F32, 1};
    std::vector<double> read = fine.uvs;
    for (double& x : read) x = 0.25 + 0.5 * x;
    auto job = sized<beltrami_bake_job>();
    job.images = &view;
    job.image_count = 1;
    job.pixels = rays > 0 ? BELTRAMI_PIXELS_OCCLUSION : BELTRAMI_PIXELS_LINEAR;
    job.wrap_u = job.wrap_v = BELTRAMI_WRAP_CLAMP;
    job.face_count = coarse.uvs.size() / 6;
    job.new_uvs = numbers(coarse.uvs);
    job.old_uvs = numbers(read);
    job.positions = numbers(coarse.places);
    job.normals = numbers(normals);
    job.source_face_count = fine.places.size() / 9;
    job.source_positions = numbers(fine.places);
    job.resolution = kSide;
    job.page_count = 1;
    job.cage = cage;
    job.rays = rays;
    auto out = sized<beltrami_baked>();
    out.pixels = pixels.data();
    const beltrami_status status = beltrami_bake(context.get(), &job, &out, nullptr, nullptr);
    texels = out.texels;
    without_source = out.without_source;
    said = message(context);
    return status;
  }
  float at(std::size_t row, std::size_t column) const { return pixels[row * kSide + column]; }
};

Place on_sphere(double radius, double u, double v) {
  // Without its poles, where triangles have no area.
  const double longitude = 6.283185307179586 * u, latitude = 2.6 * (v - 0.5);
  return {radius * std::cos(latitude) * std::cos(longitude),
          radius * std::cos(latitude) * std::sin(longitude), radius * std::sin(latitude)};
}

TEST(BakeRays, ASphereSeesTheSphereWithinAlongItsNormals) {
  Job job;
  job.fine.add_grid([](double u, double v) { return on_sphere(1, u, v); }, 24);
  job.coarse.add_grid([](double u, double v) { return on_sphere(1.3, u, v); }, 24);
  job.normals = job.coarse.places;
  EXPECT_EQ(job.bake(), BELTRAMI_E_INVALID_ARGUMENT) << "nothing is near";
  job.cage = 0.4;
  ASSERT_EQ(job.bake(), BELTRAMI_OK) << job.said;
  EXPECT_EQ(job.texels, kSide * kSide);
  EXPECT_EQ(job.without_source, 0u);
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      EXPECT_NEAR(double(job.at(row, column)), (double(column) + 0.5) / kSide, 2e-3);
    }
  }
  const std::vector<float> before = job.pixels;
  ASSERT_EQ(job.bake(2), BELTRAMI_OK);
  EXPECT_EQ(job.pixels, before) << "any number of threads gives the same bits";
}

/// A floor that is 0.2 higher beyond u = 1/2, and shows 0 below and 1 above.
Corners step() {
  Corners corners;
  corners.add([](double u, double v) { return Place{u, v, 0}; }, 0, 0, 0.5, 1);
  const std::size_t lower = corners.uvs.size();
  corners.add([](double u, double v) { return Place{u, v, 0.2}; }, 0.5, 0, 1, 1);
  for (std::size_t i = 0; i < corners.uvs.size(); i += 2) corners.uvs[i] = i < lower ? 0 : 1;
  return corners;
}

TEST(BakeRays, AStepIsSeenFromAboveWhereItIs) {
  Job job;
  job.fine = step();
  // Below both floors, so that the nearest place is another one beside the step.
  job.coarse.add([](double u, double v) { return Place{u, v, -0.05}; }, 0, 0, 1, 1);
  job.cage = 0.3;
  ASSERT_EQ(job.bake(), BELTRAMI_OK) << job.said;
  EXPECT_EQ(job.without_source, 0u);
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      EXPECT_EQ(job.at(row, column), column < kSide / 2 ? 0 : 1) << row << " " << column;
    }
  }
  job.cage = 0.1;  // the upper floor is beyond it: only what is near is shown
  job.bake();
  EXPECT_EQ(job.at(3, 3), 0);
  EXPECT_GT(job.without_source, kSide * kSide / 3);
}

TEST(BakeRays, WhatIsSeenFirstFromOutsideHidesTheRest) {
  Job job;
  job.coarse.add([](double u, double v) { return Place{u, v, 0}; }, 0, 0, 1, 1);
  job.fine = job.coarse;
  std::fill(job.fine.uvs.begin(), job.fine.uvs.end(), 0);
  Corners plate;  // floats above, and faces up
  plate.add([](double u, double v) { return Place{u, v, 0.1}; }, 0, 0, 0.5, 1);
  std::fill(plate.uvs.begin(), plate.uvs.end(), 1);
  job.fine.places.insert(job.fine.places.end(), plate.places.begin(), plate.places.end());
  job.fine.uvs.insert(job.fine.uvs.end(), plate.uvs.begin(), plate.uvs.end());
  job.cage = 0.2;
  ASSERT_EQ(job.bake(), BELTRAMI_OK) << job.said;
  EXPECT_EQ(job.at(5, 3), 1);
  EXPECT_EQ(job.at(5, 28), 0);
}

TEST(BakeRays, AWallHidesHalfOfTheSkyByItsSine) {
  Job job;
  job.coarse.add([](double u, double v) { return Place{u, v, 0}; }, 0, 0, 1, 1);
  job.fine = job.coarse;
  const double height = 0.5;
  // Along u = 0, so long that its ends are not seen.
  job.fine.add(
      [&](double u, double v) {
        return Place{0, 1000 * (u - 0.5), height * v};
      },
      0, 0, 1, 1);
  job.rays = 2048;
  ASSERT_EQ(job.bake(), BELTRAMI_OK) << job.said;
  for (std::size_t column = 0; column < kSide; ++column) {
    const double x = (double(column) + 0.5) / kSide;
    const double open = (1 + x / std::sqrt(x * x + height * height)) / 2;
    EXPECT_NEAR(double(job.at(9, column)), open, 0.01) << column;
  }
}

/// A cube whose sides are a strip of the page each, looking outwards or inwards.
Corners cube(bool outwards) {
  Corners corners;
  for (std::size_t side = 0; side < 6; ++side) {
    const auto surface = [&](double u, double v) {
      const double s = 6 * u - double(side);
      Place place{};
      place[side / 2] = side % 2 == 0 ? 1 : 0;
      const bool turned = (side % 2 == 0) == outwards;
      place[(side / 2 + 1) % 3] = turned ? s : v;
      place[(side / 2 + 2) % 3] = turned ? v : s;
      return place;
    };
    corners.add(surface, double(side) / 6, 0, double(side + 1) / 6, 1);
  }
  return corners;
}

TEST(BakeRays, ACubeSeesAllOfTheSkyAndFromWithinNothing) {
  for (const bool outwards : {true, false}) {
    Job job;
    job.coarse = cube(outwards);
    job.rays = 64;
    ASSERT_EQ(job.bake(), BELTRAMI_OK) << job.said;
    for (const float open : job.pixels) EXPECT_EQ(open, outwards ? 1 : 0);
  }
}

TEST(BakeRays, WhatIsWrongIsSaid) {
  const auto refused = [](const auto& change, const char* words) {
    Job job;
    job.coarse.add([](double u, double v) { return Place{u, v, 0}; }, 0, 0, 1, 1);
    job.fine = job.coarse;
    change(job);
    EXPECT_EQ(job.bake(), BELTRAMI_E_INVALID_ARGUMENT) << words;
    EXPECT_NE(job.said.find(words), std::string::npos) << job.said;
  };
  refused([](Job& job) { job.cage = -1; }, "cage");
  refused([](Job& job) { job.cage = std::numeric_limits<double>::quiet_NaN(); }, "cage");
  refused([](Job& job) { job.rays = 5000; }, "rays");
  refused(
      [](Job& job) {
        job.cage = 1;
        job.fine = {};
        job.rays = 1;
      },
      "source_positions");
}

}  // namespace
}  // namespace beltrami::host
