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
#include "tiny_meshes.h"

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
  EXPECT_TRUE(read_image(directory.read("p.png")).has_value());
}

TEST(Pack, FacesWithoutAreaAreNoFaultWithoutPositionsEither) {
  const TemporaryDirectory directory;
  const std::string in = directory.file(
      "in.obj", kSquares + "v 8 0 0\nv 9 0 0\nv 10 0 0\nvt .5 .5\nf 9/9 10/9 11/9\n");
  const std::string out = directory.path("out.obj");
  for (const bool keeps : {false, true}) {
    std::vector<std::string> arguments = {"pack", in, "--output", out};
    if (keeps) arguments.emplace_back("--keep-scales");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
}

TEST(Pack, MaterialsOfOneNameShareTilesAndOthersDoNot) {
  const TemporaryDirectory directory;
  std::string green = kSquares;
  green.replace(green.find("usemtl red"), 10, "usemtl green");
  std::string both = kSquares;
  both.insert(both.rfind("f 5/5"), "usemtl green\n");
  const std::string one = directory.file("one.obj", both),
                    other = directory.file("other.obj", green);
  const std::string out = directory.path("out.obj"), second = directory.path("second.obj");
  const Outcome outcome = run({"pack", one, other, "--output", out, second, "--labels", "materials",
                               "--report", directory.path("r.json")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("label      1001: usemtl red\nlabel      1002: usemtl green\n"),
            std::string::npos)
      << outcome.out;
  const auto tiles = [&](const std::string& path) {
    std::vector<int> found;
    for (const auto& [u, v] : corner_uvs(path)) found.push_back(static_cast<int>(std::floor(u)));
    return found;
  };
  EXPECT_EQ(tiles(out), (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(tiles(second), std::vector<int>(8, 1));
  const Json labels = Json::parse(directory.read("r.json"))["packing"]["labels"];
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[1]["name"], "usemtl green");
  EXPECT_EQ(labels[1]["first_page"], 1);
  EXPECT_EQ(labels[1]["last_page"], 1);
  EXPECT_EQ(run({"check", out, "--within-tiles"}).exit_code, 0);
  EXPECT_NE(run({"pack", one, directory.path("no.obj"), "--labels", "objects"})
                .err.find("no objects to give pages to"),
            std::string::npos);
  const Outcome refused =
      run({"pack", one, other, "--output", out, second, "--labels", "materials", "--kept", "1"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--labels and --kept"), std::string::npos) << refused.err;
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
  const std::optional<Pixels> mask = read_image(directory.read("mask.1001.png"));
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->width, 64);
  EXPECT_EQ(mask->height, 64);
  EXPECT_EQ(mask->components, 1);
  EXPECT_TRUE(read_image(directory.read("mask.1002.png")).has_value());
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 255), 0);
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 128), 0);
  EXPECT_GT(std::count(mask->values.begin(), mask->values.end(), 0), 0);
  EXPECT_EQ(run({"unwrap", in, out, "--pack", "none", "--masks", directory.path("m")}).exit_code,
            kExitUnusable);
}

/// Two squares side by side in the plane, the second mirrored, as two like halves have them.
const std::string kMirrored =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 5/2 6/1 7/4 8/3\n";

TEST(Pack, TakesMirroredChartsForTheirMirrorImagesWhereAsked) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kMirrored), out = directory.path("out.obj");
  const Outcome strict = run({"pack", in, out});
  EXPECT_EQ(strict.exit_code, kExitNotInjective);
  EXPECT_NE(strict.out.find("--mirrored"), std::string::npos) << strict.out;
  const Outcome mirrored =
      run({"pack", in, "--output", out, "--mirrored", "--report", directory.path("r.json")});
  EXPECT_EQ(mirrored.exit_code, 0) << mirrored.err << mirrored.out;
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["injective"]["mirrored_charts"], 1);
  EXPECT_EQ(json["injective"]["float32"], true);
  EXPECT_EQ(json["status"], "BELTRAMI_OK");
  const auto uvs = corner_uvs(out);
  EXPECT_GT(area(uvs, 0), 0);
  EXPECT_LT(area(uvs, 4), 0) << "it stays mirrored";
  EXPECT_EQ(run({"check", out}).exit_code, kExitNotInjective);
  EXPECT_EQ(run({"check", out, "--mirrored"}).exit_code, 0);
}

// Its chart overlaps itself in any numbers.
TEST(Pack, DoesNotSayThatDoublesWouldHelpWhereAChartOverlapsItself) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", fan_beyond_a_circle());
  const Outcome outcome = run({"pack", in, directory.path("out.obj"), "--float32"});
  EXPECT_EQ(outcome.exit_code, kExitNotInjective) << outcome.err;
  EXPECT_EQ(outcome.out.find("injective in double precision"), std::string::npos) << outcome.out;
}

TEST(Pack, MirroredChartsThatFoldAreAFaultStill) {
  const TemporaryDirectory directory;
  std::string folded = kMirrored;
  folded.replace(folded.find("f 5/2"), std::string::npos, "f 5/2 6/1 7/4\nf 5/2 7/4 8/1\n");
  const std::string in = directory.file("in.obj", folded);
  EXPECT_EQ(run({"pack", in, directory.path("out.obj"), "--mirrored"}).exit_code,
            kExitNotInjective);
}

}  // namespace
}  // namespace beltrami::cli
