// beltrami transfer, end to end.
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
  const std::optional<Pixels> image = read_image(directory.read("new.png"));
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
    if (outcome.exit_code == 0) image = read_image(directory_.read("new.png"));
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
  // Most of it far away is too much.
  std::string larger = half_far;
  larger.replace(larger.find("vt .5 .5"), 8, "vt .4 .5");
  const Transferred most(kSquare, larger, ramps());
  EXPECT_EQ(most.outcome.exit_code, kExitUnusable);
  EXPECT_NE(most.outcome.err.find("are near nothing of"), std::string::npos) << most.outcome.err;
  // All of it far away, or turned over: nothing can be read.
  std::string far = half_far;
  far.replace(0, far.find("v 5"), "v 8 0 0\nv 9 0 0\nv 8 1 0\n");
  EXPECT_EQ(Transferred(kSquare, far, ramps()).outcome.exit_code, kExitUnusable);
  const std::string over = kSquare.substr(0, kSquare.find("f ")) + "f 1/1 4/4 3/3 2/2\n";
  EXPECT_EQ(Transferred(kSquare, over, ramps()).outcome.exit_code, kExitUnusable);
}

/// Files of a run of transfer with a texture of 64 texels a side.
class Baking {
 public:
  std::string mesh(const std::string& name, const std::string& text) const {
    return directory.file(name, text);
  }
  std::string texture(const std::string& name, const std::vector<std::uint8_t>& texels) const {
    return directory.file(name,
                          png_bytes(Transferred::kSide, Transferred::kSide, 3, texels.data()));
  }
  std::array<int, 3> at(const std::string& name, double u, double v) const {
    const std::optional<Pixels> image = read_image(directory.read(name));
    const auto column = static_cast<std::size_t>(u * image->width),
               row = static_cast<std::size_t>((1 - v) * image->height);
    const std::uint8_t* texel =
        &image->values[3 * row * static_cast<std::size_t>(image->width) + 3 * column];
    return {texel[0], texel[1], texel[2]};
  }
  TemporaryDirectory directory;
};

/// A square with these UVs at its corners (0,0) and (1,1).
std::string square_with(const std::string& u0, const std::string& v0, const std::string& u1,
                        const std::string& v1) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt " + u0 + " " + v0 + "\nvt " + u1 + " " + v0 +
         "\nvt " + u1 + " " + v1 + "\nvt " + u0 + " " + v1 + "\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
}

TEST(Transfer, ReadsTexturesThatRepeat) {
  const Baking baking;
  const std::string floor = baking.mesh("floor.obj", square_with("-1", "0", "3", "4")),
                    page = baking.mesh("page.obj", kSquare),
                    texture = baking.texture("t.png", ramps()),
                    out = baking.directory.path("o.png");
  const Outcome outcome = run({"transfer", floor, page, texture, out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("repeats"), std::string::npos) << outcome.out;
  // u = 4 * 0.4 - 1 = 0.6, v = 4 * 0.2 = 0.8; and so on.
  EXPECT_NEAR(baking.at("o.png", 0.4, 0.2)[0], 2 * 0.6 * 64, 6);
  EXPECT_NEAR(baking.at("o.png", 0.4, 0.2)[1], 2 * 0.8 * 64, 6);
  EXPECT_NEAR(baking.at("o.png", 0.9, 0.6)[0], 2 * 0.6 * 64, 6);
  EXPECT_NEAR(baking.at("o.png", 0.9, 0.6)[1], 2 * 0.4 * 64, 6);
  ASSERT_EQ(run({"transfer", floor, page, texture, out, "--wrap", "mirror"}).exit_code, 0);
  EXPECT_NEAR(baking.at("o.png", 0.65, 0.2)[0], 2 * 0.4 * 64, 6) << "u = 1.6 shows 0.4";
  ASSERT_EQ(run({"transfer", floor, page, texture, out, "--wrap", "clamp"}).exit_code, 0);
  EXPECT_EQ(baking.at("o.png", 0.9, 0.1)[0], 2 * 63) << "u = 2.6 shows the edge";
  const Outcome tiles = run({"transfer", floor, page, texture, out, "--wrap", "tiles"});
  EXPECT_EQ(tiles.exit_code, kExitUnusable);
  EXPECT_NE(tiles.err.find("--wrap repeat"), std::string::npos) << tiles.err;
}

TEST(Transfer, ReadsTilesWhereTheyAreBesideTheTexture) {
  const Baking baking;
  const std::string old_mesh = baking.mesh("old.obj", square_with("1", "0", "2", "1")),
                    page = baking.mesh("page.obj", kSquare), out = baking.directory.path("o.png");
  const std::string texture = baking.texture("t.png", std::vector<std::uint8_t>(3 * 64 * 64, 9));
  baking.texture("t.1002.png", ramps());
  const Outcome outcome = run({"transfer", old_mesh, page, texture, out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(baking.at("o.png", 0.4, 0.2)[0], 2 * 0.4 * 64, 3);
  ASSERT_EQ(run({"transfer", old_mesh, page, texture, out, "--wrap", "repeat"}).exit_code, 0);
  EXPECT_EQ(baking.at("o.png", 0.4, 0.2)[0], 9);
}

TEST(Transfer, WhatLiesOnTheEdgeOfAPageBelongsToIt) {
  const Baking baking;
  // The second face is a line at u = 1, the third a point of unused UVs.
  const std::string edge =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 1 0.5\nf 1/1 2/2 3/3\n"
      "f 1/2 3/3 4/4\nf 1/1 2/1 4/1\n";
  const std::string old_mesh = baking.mesh("old.obj", edge),
                    texture = baking.texture("t.png", ramps());
  const Outcome outcome =
      run({"transfer", old_mesh, old_mesh, texture, baking.directory.path("o.png")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("repeats"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("pages      1 of"), std::string::npos) << outcome.out;
}

/// The smallest JPEG file: 8 x 8 texels of one grey, quantised by 1 and coded by two words.
std::string grey_jpeg() {
  std::string bytes = "\xFF\xD8\xFF\xDB";
  bytes += std::string("\0\x43\0", 3) + std::string(64, '\1');                // quantisation
  bytes += "\xFF\xC0" + std::string("\0\x0B\x08\0\x08\0\x08\1\1\x11\0", 11);  // frame
  for (const char table : {'\0', '\x10'}) {  // of codes: one of one bit, for the symbol 0
    bytes += "\xFF\xC4" + std::string("\0\x14", 2) + table + '\1' + std::string(16, '\0');
  }
  bytes += "\xFF\xDA" + std::string("\0\x08\1\1\0\0\x3F\0", 8);  // scan
  return bytes + "\x3F\xFF\xD9";                                 // two codes 0, filled by ones
}

TEST(Transfer, ReadsJpegAndSaysWhatItCannotRead) {
  const Baking baking;
  const std::string page = baking.mesh("page.obj", kSquare), out = baking.directory.path("o.png");
  const std::string jpeg = baking.directory.file("t.jpg", grey_jpeg());
  const Outcome outcome = run({"transfer", page, page, jpeg, out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::optional<Pixels> image = read_image(baking.directory.read("o.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 8);
  EXPECT_EQ(image->components, 1);
  EXPECT_EQ(image->values[27], 128);
  EXPECT_NE(run({"transfer", page, page, "normal", out}).err.find("'normals' bakes what OLD"),
            std::string::npos);
  const std::string glb = baking.directory.file("t.glb", "glTF");
  EXPECT_NE(run({"transfer", page, page, glb, out}).err.find("save it as"), std::string::npos);
  EXPECT_EQ(run({"transfer", page, page, jpeg, baking.directory.path("o.jpg")}).exit_code,
            kExitUnusable);
}

}  // namespace
}  // namespace beltrami::cli
