// beltrami transfer of what a fine mesh has itself, end to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "picture/light.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

/// Of the fine mesh, above the unit square.
double height(double x, double y) {
  return 0.01 * std::sin(6 * x) * std::cos(5 * y);
}

std::string fine_mesh() {
  constexpr int kSide = 96;
  std::string text;
  for (int j = 0; j <= kSide; ++j) {
    for (int i = 0; i <= kSide; ++i) {
      const double x = double(i) / kSide, y = double(j) / kSide;
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(height(x, y)) + "\n";
    }
  }
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int a = 1 + j * (kSide + 1) + i, b = a + kSide + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(b + 1) +
              " " + std::to_string(b) + "\n";
    }
  }
  return text;
}

/// The unit square, with UVs that are turned by a quarter: u is y, v is 1 - x.
const std::string kCoarse =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
    "f 1/1 2/2 3/3 4/4\n";

class Detail : public testing::Test {
 protected:
  Outcome transfer(const std::string& what, const std::string& out) {
    return run({"transfer", directory.file("fine.obj", fine_mesh()),
                directory.file("coarse.obj", kCoarse), what, directory.path(out), "--resolution",
                "64"});
  }
  TemporaryDirectory directory;
};

/// Place of the unit square that a texel of 64 shows.
std::array<double, 2> place(std::size_t row, std::size_t column) {
  return {(double(row) + 0.5) / 64, (double(column) + 0.5) / 64};
}

TEST_F(Detail, NormalsAreAlongTheTangentsOfTheCoarseMesh) {
  const Outcome outcome = transfer("normals", "n.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::optional<Pixels> image = read_image(directory.read("n.png"));
  ASSERT_TRUE(image);
  ASSERT_EQ(image->components, 3);
  ASSERT_EQ(image->bytes, 2u);
  for (std::size_t row = 4; row < 60; row += 3) {
    for (std::size_t column = 4; column < 60; column += 3) {
      const auto [x, y] = place(row, column);
      const double dx = 0.06 * std::cos(6 * x) * std::cos(5 * y);
      const double dy = -0.05 * std::sin(6 * x) * std::sin(5 * y);
      const double length = std::sqrt(1 + dx * dx + dy * dy);
      // The tangent is y, and what is up on the picture is -x.
      const std::array<double, 3> wanted = {-dy / length, dx / length, 1 / length};
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint16_t value = 0;
        std::memcpy(&value, &image->values[2 * (3 * (64 * row + column) + k)], 2);
        EXPECT_NEAR(2 * value / 65535.0 - 1, wanted[k], 0.004) << row << " " << column << " " << k;
      }
    }
  }
}

TEST_F(Detail, HeightsAreInTheUnitOfTheMesh) {
  if (!has_exr()) GTEST_SKIP() << "built without OpenEXR";
  const Outcome outcome = transfer("heights", "h.exr");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::optional<Pixels> image = read_light(directory.read("h.exr"));
  ASSERT_TRUE(image);
  ASSERT_EQ(image->components, 1);
  for (std::size_t row = 4; row < 60; row += 3) {
    for (std::size_t column = 4; column < 60; column += 3) {
      const auto [x, y] = place(row, column);
      float value = 0;
      std::memcpy(&value, &image->values[4 * (64 * row + column)], 4);
      // The nearest place is not quite that along the normal.
      EXPECT_NEAR(double(value), height(x, y), 4e-4) << row << " " << column;
    }
  }
}

TEST_F(Detail, APngOfHeightsHasItsScaleInTheSummary) {
  const Outcome outcome = transfer("heights", "h.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("heights    up to 0.00"), std::string::npos) << outcome.out;
  const std::optional<Pixels> image = read_image(directory.read("h.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->components, 1);
  EXPECT_EQ(image->bytes, 2u);
}

TEST_F(Detail, OcclusionIsGreyOfOneByte) {
  const std::string fine = directory.file("fine.obj", fine_mesh());
  // A wall along x = 0 above the coarse square.
  const std::string walled =
      fine_mesh() + "v 0 -50 0\nv 0 50 0\nv 0 50 0.5\nv 0 -50 0.5\n" + "f -4 -3 -2 -1\n";
  const Outcome outcome =
      run({"transfer", directory.file("walled.obj", walled), directory.file("coarse.obj", kCoarse),
           "occlusion", directory.path("o.png"), "--resolution", "64", "--rays", "512", "--cage",
           "0.05"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("cage"), std::string::npos) << outcome.out;
  const std::optional<Pixels> image = read_image(directory.read("o.png"));
  ASSERT_TRUE(image);
  ASSERT_EQ(image->components, 1);
  ASSERT_EQ(image->bytes, 1u);
  for (std::size_t row = 8; row < 60; row += 3) {
    const double x = place(row, 30)[0];
    const double open = (1 + x / std::sqrt(x * x + 0.25)) / 2;
    // The waves of the floor hide some more of it.
    EXPECT_NEAR(image->values[64 * row + 30] / 255.0, open, 0.06) << row;
  }
  const Outcome rays = run({"transfer", fine, directory.path("coarse.obj"), "normals",
                            directory.path("n.png"), "--rays", "4"});
  EXPECT_EQ(rays.exit_code, kExitUnusable);
  EXPECT_NE(rays.err.find("--rays"), std::string::npos) << rays.err;
}

TEST_F(Detail, PagesOfUdimHaveOneScaleOfHeights) {
  // The square in two halves, the second of which is on the next tile.
  const std::string coarse =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 0 0\nv .5 1 0\n"
      "vt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1.5 0\nvt 2 0\nvt 2 1\nvt 1.5 1\n"
      "f 1/1 5/2 6/3 4/4\nf 5/5 2/6 3/7 6/8\n";
  const Outcome outcome =
      run({"transfer", directory.file("fine.obj", fine_mesh()), directory.file("two.obj", coarse),
           "heights", directory.path("h.png"), "--resolution", "64"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("pages      2"), std::string::npos) << outcome.out;
  double most = 0;
  for (const char* name : {"h.1001.png", "h.1002.png"}) {
    const std::optional<Pixels> image = read_image(directory.read(name));
    ASSERT_TRUE(image) << name;
    const bool second = name[5] == '2';
    for (std::size_t row = 4; row < 60; row += 5) {
      for (std::size_t column = 4; column < 28; column += 5) {
        const std::size_t at = column + (second ? 32 : 0);
        std::uint16_t value = 0;
        std::memcpy(&value, &image->values[2 * (64 * row + at)], 2);
        const double x = (double(at) + 0.5) / 64, y = 1 - (double(row) + 0.5) / 64;
        // White stands for the greatest height of both pages, which is nearly 0.01.
        EXPECT_NEAR(2 * value / 65535.0 - 1, height(x, y) / 0.01, 0.06) << name;
        most = std::max(most, std::abs(2 * value / 65535.0 - 1));
      }
    }
  }
  EXPECT_GT(most, 0.8);
}

TEST_F(Detail, WhatIsFarAwayIsRefused) {
  const std::string far = "v 9 0 0\nv 10 0 0\nv 10 1 0\nf 1 2 3\n";
  const Outcome outcome =
      run({"transfer", directory.file("far.obj", far), directory.file("coarse.obj", kCoarse),
           "normals", directory.path("n.png")});
  EXPECT_EQ(outcome.exit_code, kExitUnusable);
  EXPECT_NE(outcome.err.find("are near nothing of"), std::string::npos) << outcome.err;
  const Outcome format = transfer("normals", "n.hdr");
  EXPECT_EQ(format.exit_code, kExitUnusable);
}

}  // namespace
}  // namespace beltrami::cli
