// beltrami pack and transfer, end to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "files/polygons.h"
#include "picture/stb_in_one_place.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

/// Two squares in space whose UVs are of other sizes, the first in a material.
const std::string kSquares =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 7 2 0\nv 5 2 0\n"
    "vt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\nvt 4 0\nvt 5 0\nvt 5 1\nvt 4 1\n"
    "usemtl red\nf 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n";

std::vector<std::array<double, 2>> corner_uvs(const std::string& path) {
  const MeshFile file = read_mesh(path, Content::kUvs);
  const bool per_vertex = file.corner_uvs.of_corner.empty();
  const std::vector<double>& values = per_vertex ? file.uvs : file.corner_uvs.values;
  std::vector<std::array<double, 2>> uvs;
  for (const std::uint32_t i : per_vertex ? file.polygons.corners() : file.corner_uvs.of_corner) {
    uvs.push_back({values[2 * std::size_t{i}], values[2 * std::size_t{i} + 1]});
  }
  return uvs;
}

/// Signed area of the quad that begins with this corner.
double area(const std::vector<std::array<double, 2>>& uvs, std::size_t first) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &a = uvs[first + k], &b = uvs[first + (k + 1) % 4];
    sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return sum;
}

TEST(Pack, EvensDensitiesOutAndKeepsWhatFacesHave) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), out = directory.path("out.obj");
  const Outcome outcome = run({"pack", in, out, "--resolution", "128", "--report",
                               directory.path("r.json"), "--picture", directory.path("p.png")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("injective  yes"), std::string::npos) << outcome.out;
  EXPECT_NE(directory.read("out.obj").find("usemtl red"), std::string::npos);
  EXPECT_EQ(run({"check", out}).exit_code, 0);
  const auto uvs = corner_uvs(out);
  EXPECT_NEAR(area(uvs, 4) / area(uvs, 0), 4, 1e-9);
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["command"], "pack");
  EXPECT_EQ(json["charts"], 2);
  EXPECT_EQ(json["packing"]["pages"], 1);
  EXPECT_GE(json["packing"]["margin"], 2);
  EXPECT_NEAR(json["packing"]["utilisation"], area(uvs, 0) + area(uvs, 4), 1e-9);
  EXPECT_TRUE(read_png(directory.read("p.png")).has_value());
}

TEST(Pack, KeepsScalesWhereAsked) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), out = directory.path("out.ply");
  ASSERT_EQ(run({"pack", in, out, "--keep-scales"}).exit_code, 0);
  const auto uvs = corner_uvs(out);
  EXPECT_NEAR(area(uvs, 0) / area(uvs, 4), 9, 1e-6);
}

TEST(Pack, PutsSeveralMeshesOnPagesAndLeavesThoseThatStay) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), a = directory.path("a.obj"),
                    b = directory.path("b.obj"), c = directory.path("c.obj");
  ASSERT_EQ(run({"pack", in, a, "--texels-per-unit", "400"}).exit_code, 0);
  ASSERT_EQ(run({"pack", a, in, "--output", b, c, "--kept", "1", "--max-pages", "9", "--report",
                 directory.path("r.json")})
                .exit_code,
            0);
  EXPECT_EQ(corner_uvs(a), corner_uvs(b));
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_NEAR(json["packing"]["texels_per_unit"], 400, 1e-6);
  EXPECT_GT(json["packing"]["pages"], 1);
  const auto uvs = corner_uvs(c);
  const auto last = std::max_element(uvs.begin(), uvs.end(),
                                     [](const auto& p, const auto& q) { return p[0] < q[0]; });
  EXPECT_GT((*last)[0], 1) << "on a page behind the first";
}

TEST(Pack, RefusesWhatItCannotDo) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), out = directory.path("out.obj");
  EXPECT_EQ(run({"pack", in}).exit_code, kExitUnusable);
  EXPECT_EQ(run({"pack", in, in, in, "--output", out}).exit_code, kExitUnusable);
  const std::string bare = directory.file("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome no_uvs = run({"pack", bare, out});
  EXPECT_EQ(no_uvs.exit_code, kExitUnusable);
  EXPECT_EQ(no_uvs.err_lines(), 1) << no_uvs.err;
  const Outcome dense = run({"pack", in, out, "--texels-per-unit", "9000"});
  EXPECT_EQ(dense.exit_code, kExitUnusable);
  EXPECT_EQ(dense.err_lines(), 1) << dense.err;
}

TEST(Pack, WritesMasksOfEveryPage) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), out = directory.path("out.obj");
  ASSERT_EQ(run({"unwrap", in, out, "--resolution", "64", "--texels-per-unit", "30", "--max-pages",
                 "2", "--masks", directory.path("mask")})
                .exit_code,
            0);
  const auto uvs = corner_uvs(out);
  const std::optional<Pixels> mask = read_png(directory.read("mask.1001.png"));
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->width, 64);
  EXPECT_EQ(mask->height, 64);
  EXPECT_EQ(mask->components, 1);
  EXPECT_TRUE(read_png(directory.read("mask.1002.png")).has_value());
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 255), 0);
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 128), 0);
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 0), 0);
  EXPECT_EQ(run({"unwrap", in, out, "--pack", "none", "--masks", directory.path("m")}).exit_code,
            kExitUnusable);
}

// A ramp over the first square, and another one over the second: what a corner shows stays.
TEST(Transfer, CarriesATextureToOtherUvs) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquares), a = directory.path("a.obj"),
                    b = directory.path("b.obj");
  constexpr int kSide = 256;
  ASSERT_EQ(run({"pack", in, a, "--resolution", "256"}).exit_code, 0);
  ASSERT_EQ(run({"pack", in, b, "--resolution", "256", "--keep-scales", "--margin", "8"}).exit_code,
            0);
  std::vector<std::uint8_t> ramp;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      for (const int value : {column, row, 77}) ramp.push_back(static_cast<std::uint8_t>(value));
    }
  }
  const std::string texture = directory.file("old.png", png_bytes(kSide, kSide, 3, ramp.data()));
  const Outcome outcome = run({"transfer", a, b, texture, directory.path("new.png")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::optional<Pixels> image = read_png(directory.read("new.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, kSide);
  EXPECT_EQ(image->components, 3);
  const auto from = corner_uvs(a), to = corner_uvs(b);
  for (const std::size_t quad : {0, 4}) {
    std::array<double, 2> source{}, target{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t d = 0; d < 2; ++d) {
        source[d] += from[quad + k][d] / 4;
        target[d] += to[quad + k][d] / 4;
      }
    }
    const auto column = static_cast<std::size_t>(target[0] * kSide);
    const auto row = static_cast<std::size_t>((1 - target[1]) * kSide);
    const std::uint8_t* texel = &image->values[3 * (row * kSide + column)];
    EXPECT_NEAR(texel[0], source[0] * kSide - 0.5, 6);
    EXPECT_NEAR(texel[1], (1 - source[1]) * kSide - 0.5, 6);
    EXPECT_EQ(texel[2], 77);
  }
  EXPECT_EQ(run({"transfer", a, a, texture, directory.path("same.png")}).exit_code, 0);
  EXPECT_EQ(run({"transfer", a, b, in, directory.path("x.png")}).exit_code, kExitUnusable);
}

/// Files of a mesh and a texture of some texels per side, and what a transfer makes of them.
class Transferred {
 public:
  static constexpr int kSide = 64;

  Transferred(const std::string& from, const std::string& to,
              const std::vector<std::uint8_t>& texture) {
    const std::string old_mesh = directory_.file("old.obj", from),
                      new_mesh = directory_.file("new.obj", to),
                      read = directory_.file("old.png", png_bytes(kSide, kSide, 3, texture.data()));
    outcome = run({"transfer", old_mesh, new_mesh, read, directory_.path("new.png")});
    if (outcome.exit_code == 0) image = read_png(directory_.read("new.png"));
  }

  /// The colour at a place of the new layout.
  std::array<int, 3> at(double u, double v) const {
    const auto column = static_cast<std::size_t>(u * kSide),
               row = static_cast<std::size_t>((1 - v) * kSide);
    const std::uint8_t* texel = &image->values[3 * (row * kSide + column)];
    return {texel[0], texel[1], texel[2]};
  }

  Outcome outcome;
  std::optional<Pixels> image;

 private:
  TemporaryDirectory directory_;
};

/// A texture with twice the column in red and twice the row from below in green.
std::vector<std::uint8_t> ramps() {
  std::vector<std::uint8_t> texels;
  for (int row = 0; row < Transferred::kSide; ++row) {
    for (int column = 0; column < Transferred::kSide; ++column) {
      for (const int value : {2 * column, 2 * (Transferred::kSide - 1 - row), 0}) {
        texels.push_back(static_cast<std::uint8_t>(value));
      }
    }
  }
  return texels;
}

/// A square of two triangles on all of the page.
const std::string kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

void expect_ramps(const Transferred& transferred) {
  ASSERT_EQ(transferred.outcome.exit_code, 0) << transferred.outcome.err;
  for (const double u : {0.1, 0.4, 0.8}) {
    for (const double v : {0.2, 0.5, 0.9}) {
      EXPECT_NEAR(transferred.at(u, v)[0], 2 * u * Transferred::kSide, 3);
      EXPECT_NEAR(transferred.at(u, v)[1], 2 * v * Transferred::kSide, 3);
    }
  }
}

TEST(Transfer, GoesByPlacesWhereTheTrianglesAreOthers) {
  // The other diagonal, vertices in another order, and the square as one polygon.
  const std::string vertices =
      "v 1 1 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nvt 1 1\nvt 0 1\nvt 0 0\nvt 1 0\n";
  expect_ramps({kSquare, vertices + "f 1/1 2/2 4/4\nf 2/2 3/3 4/4\n", ramps()});
  expect_ramps({kSquare, vertices + "f 3/3 1/1 2/2\nf 3/3 4/4 1/1\n", ramps()});
  expect_ramps({kSquare, vertices + "f 1/1 2/2 3/3 4/4\n", ramps()});
}

TEST(Transfer, GoesByPlacesWhereFacesOfTheirOwnVerticesChangeTheirOrder) {
  // The numbers of all corners are those of the old mesh.
  const std::string old_soup =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\n"
      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
  const std::string new_soup =
      "v 0 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\n"
      "vt 0 0\nvt 1 1\nvt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
  expect_ramps({old_soup, new_soup, ramps()});
}

TEST(Transfer, GoesByFacesWhereTheSameMeshHasMoved) {
  std::string moved = kSquare;
  moved.replace(0, moved.find("vt"), "v 0 0 7\nv 0 2 7\nv 0 2 9\nv 0 0 9\n");
  expect_ramps({kSquare, moved, ramps()});
}

TEST(Transfer, KeepsTheSidesOfAThinWallApart) {
  // A wall of two faces back to back, each on a half of the page; the new one has them cut across.
  const std::string wall =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -0.001\nv 1 0 -0.001\nv 1 1 -0.001\n"
      "v 0 1 -0.001\nvt 0 0\nvt .5 0\nvt .5 1\nvt 0 1\nvt 1 0\nvt 1 1\n";
  const std::string whole = wall + "f 1/1 2/2 3/3 4/4\nf 6/2 5/5 8/6 7/3\n";
  const std::string cut = wall + "f 1/1 2/2 4/4\nf 2/2 3/3 4/4\nf 6/2 5/5 7/3\nf 5/5 8/6 7/3\n";
  std::vector<std::uint8_t> halves;
  for (int i = 0; i < Transferred::kSide * Transferred::kSide; ++i) {
    const bool left = i % Transferred::kSide < Transferred::kSide / 2;
    halves.insert(halves.end(), {static_cast<std::uint8_t>(left ? 200 : 10), 50, 90});
  }
  const Transferred transferred(whole, cut, halves);
  ASSERT_EQ(transferred.outcome.exit_code, 0) << transferred.outcome.err;
  for (const double v : {0.2, 0.5, 0.9}) {
    for (const double u : {0.1, 0.25, 0.4}) EXPECT_EQ(transferred.at(u, v)[0], 200);
    for (const double u : {0.6, 0.75, 0.9}) EXPECT_EQ(transferred.at(u, v)[0], 10);
  }
}

TEST(Transfer, CountsTexelsThatNothingIsNear) {
  // One of two triangles lies over the square, the other far from it.
  const std::string half_far =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\n"
      "vt 0 0\nvt .5 0\nvt 0 .5\nvt .5 .5\nvt 1 .5\nvt .5 1\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
  const Transferred half(kSquare, half_far, ramps());
  ASSERT_EQ(half.outcome.exit_code, 0) << half.outcome.err;
  EXPECT_NE(half.outcome.out.find("no source  528 of 1056 texels"), std::string::npos)
      << half.outcome.out;
  EXPECT_EQ(half.at(0.7, 0.7), (std::array<int, 3>{0, 0, 0}));
  EXPECT_GT(half.at(0.2, 0.2)[0], 0);
  // All of it far away, or turned over: nothing can be read.
  std::string far = half_far;
  far.replace(0, far.find("v 5"), "v 8 0 0\nv 9 0 0\nv 8 1 0\n");
  EXPECT_EQ(Transferred(kSquare, far, ramps()).outcome.exit_code, kExitUnusable);
  const std::string over = kSquare.substr(0, kSquare.find("f ")) + "f 1/1 4/4 3/3 2/2\n";
  EXPECT_EQ(Transferred(kSquare, over, ramps()).outcome.exit_code, kExitUnusable);
}

}  // namespace
}  // namespace beltrami::cli
