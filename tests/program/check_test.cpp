// beltrami check, end to end.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "gltf_builder.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

// Two charts, and a face on a line of the surface that has a corner in each.
TEST(Check, FacesWithoutAreaTakeNothingOfTheMargin) {
  const TemporaryDirectory directory;
  const std::string in =
      directory.file("in.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .2 -1 1\nv .8 0 0\nv .5 0 0\n"
                     "f 1 2 3 4\nf 1 5 6\nf 1 7 6 2\n");
  const std::string out = directory.path("out.obj");
  ASSERT_EQ(run({"unwrap", in, out}).exit_code, 0);
  const Outcome checked = run({"check", out, "--margin", "2"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
}

TEST(Check, AcceptsAnInjectiveMap) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquareWithUvs);
  const Outcome outcome = run(
      {"check", in, "--report", directory.path("r.json"), "--picture", directory.path("p.png")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["command"], "check");
  EXPECT_EQ(json["status"], "BELTRAMI_OK");
  EXPECT_EQ(json["options"]["float32"], false);
  EXPECT_EQ(json["input"]["boundary_edges"], 4);
  EXPECT_EQ(json["injective"]["result"], true);
  EXPECT_TRUE(json["coarse_faces"].is_null());
  EXPECT_EQ(json["stages"].front()["name"], "read");
}

TEST(Check, FindsFlippedFaces) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquareWithFlip);
  const Outcome outcome = run({"check", in, "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("NO: 1 flipped"), std::string::npos) << outcome.out;
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["status"], "BELTRAMI_NOT_INJECTIVE");
  EXPECT_EQ(json["injective"]["negative"], 1);
  EXPECT_EQ(json["injective"]["first_bad_face"], 1);
}

TEST(Check, FindsOverlapsOfTheBoundaryWithoutAnyFlip) {
  const TemporaryDirectory directory;
  const Outcome outcome = run({"check", directory.file("in.obj", fan_beyond_a_circle()), "--report",
                               directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["injective"]["negative"], 0);
  EXPECT_GT(json["injective"]["boundary_crossings"], 0);
}

TEST(Check, JudgesSinglePrecisionOnRequest) {
  // 1 + 2^-30 is 1 in single precision, where the second triangle has no area.
  const TemporaryDirectory directory;
  const std::string in = directory.file(
      "in.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0.25\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 1 1.0000000009313226\n"
      "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  const Outcome exact = run({"check", in, "--report", directory.path("r.json")});
  EXPECT_EQ(exact.exit_code, 0);
  EXPECT_NE(exact.out.find("NOT when rounded to float32"), std::string::npos) << exact.out;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["injective"]["float32"], false);
  EXPECT_EQ(run({"check", in, "--float32"}).exit_code, 3);
}

// At the one scale that is best: a page has its own unit. Of two equal triangles, one with UVs
// twice as long as the other's, the best mean is 2.5.
TEST(Check, MeasuresEnergiesAtTheBestScale) {
  const TemporaryDirectory directory;
  const std::string two =
      "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 5000 0 0\nv 6000 0 0\nv 5000 1000 0\n"
      "vt 0 0\nvt .1 0\nvt 0 .1\nvt .5 0\nvt .7 0\nvt .5 .2\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
  const std::string one =
      "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nvt 0 0\nvt 1e-9 0\nvt 0 1e-9\nf 1/1 2/2 3/3\n";
  for (const auto& [text, mean] : {std::pair(two, 2.5), std::pair(one, 2.0)}) {
    const std::string in = directory.file("in.obj", text);
    EXPECT_EQ(run({"check", in, "--report", directory.path("r.json")}).exit_code, 0);
    const Json json = Json::parse(directory.read("r.json"));
    EXPECT_NEAR(json["energy"]["symmetric_dirichlet"].get<double>(), mean, 1e-12);
  }
}

TEST(Check, ReadsTheNamesThatPlyWritersUse) {
  for (const std::string names : {"s t", "u v", "texture_u texture_v"}) {
    const TemporaryDirectory directory;
    const std::size_t blank = names.find(' ');
    const std::string in = directory.file(
        "in.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty float " +
            names.substr(0, blank) + "\nproperty float " + names.substr(blank + 1) +
            "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(run({"check", in}).exit_code, 0) << names;
  }
}

TEST(Check, JudgesWhatIsNoDiskAsAnAtlas) {
  const TemporaryDirectory directory;
  const std::string seam =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 4\n"
      "f 1/1 2/2 3/3\nf 1/1 3/5 4/4\n";
  const std::string parts =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 5 0\n"
      "vt 6 0\nvt 5 1\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n";
  EXPECT_EQ(run({"check", directory.file("in.obj", parts)}).exit_code, 0);
  EXPECT_EQ(run({"check", directory.file("in.obj", seam)}).exit_code, 3) << "the two overlap";
  // The second part is mirrored.
  std::string mirrored = parts;
  mirrored.replace(mirrored.find("vt 6 0"), 6, "vt 4 0");
  const std::string in = directory.file("in.obj", mirrored);
  EXPECT_EQ(run({"check", in}).exit_code, 3);
  EXPECT_EQ(run({"check", in, "--mirrored"}).exit_code, 0);
}

/// Two squares a tenth of a page apart, a twentieth from its edges, on the tile `u` to the right.
std::string two_squares(const std::string& u) {
  return "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 7 0 0\nv 7 2 0\nv 5 2 0\n"
         "vt " +
         u + ".05 .05\nvt " + u + ".45 .05\nvt " + u + ".45 .45\nvt " + u +
         ".05 .45\n"
         "vt " +
         u + ".55 .05\nvt " + u + ".95 .05\nvt " + u + ".95 .45\nvt " + u +
         ".55 .45\n"
         "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n";
}

// Found by the fuzzer of the program: a quad with two corners at one place, whose corners have
// a UV each, looks like a disk.
TEST(Check, LeavesFacesWithoutAreaOutOfDisksToo) {
  const TemporaryDirectory directory;
  const std::string in =
      directory.file("in.obj", "v 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const std::string out = directory.path("out.obj");
  ASSERT_EQ(run({"unwrap", in, out, "--cut", "minimal"}).exit_code, 0);
  const Outcome outcome = run({"check", out});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
}

TEST(Check, SaysWhereChartsLieHowFarApartAndHowDense) {
  const TemporaryDirectory directory;
  for (const auto& [u, tile] : {std::pair<std::string, int>{"0", 1001}, {"3", 1004}}) {
    const std::string in = directory.file("in.obj", two_squares(u));
    const Outcome outcome =
        run({"check", in, "--resolution", "200", "--report", directory.path("r.json")});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Json layout = Json::parse(directory.read("r.json"))["layout"];
    EXPECT_NEAR(layout["bounds"][0], std::stod(u) + 0.05, 1e-12);
    EXPECT_NEAR(layout["bounds"][3], 0.45, 1e-12);
    EXPECT_EQ(layout["tiles"], Json::array({tile}));
    EXPECT_NEAR(layout["chart_distance"], 20, 1e-9);
    EXPECT_NEAR(layout["edge_distance"], 10, 1e-9);
    EXPECT_NEAR(layout["margin"], 20, 1e-9);
    EXPECT_NEAR(layout["greatest_texels_per_unit"], 80, 1e-9);
    EXPECT_NEAR(layout["least_texels_per_unit"], 40, 1e-9);
    EXPECT_NEAR(layout["texels_per_unit"], 200 * std::sqrt(0.32 / 5), 1e-9);
    EXPECT_NEAR(layout["utilisation"], 0.32, 1e-9);
    EXPECT_EQ(layout["outside"], u == "0" ? 0 : 2);
    EXPECT_EQ(layout["astride"], 0);
    EXPECT_NE(outcome.out.find("margin     20.000 texels at 200 a side"), std::string::npos)
        << outcome.out;
  }
}

TEST(Check, SaysTheDensityOfEachMaterialAndChart) {
  // Two squares: the one of wood has a quarter of the page, that of brass a sixteenth.
  const TemporaryDirectory directory;
  const std::string in = directory.file(
      "in.obj",
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 5 0 0\nv 7 0 0\nv 7 2 0\nv 5 2 0\n"
      "vt 0 0\nvt .5 0\nvt .5 .5\nvt 0 .5\nvt .6 .6\nvt .85 .6\nvt .85 .85\nvt .6 .85\n"
      "usemtl wood\nf 1/1 2/2 3/3 4/4\nusemtl brass\nf 5/5 6/6 7/7 8/8\n");
  const Outcome outcome = run({"check", in, "--labels", "materials", "--resolution", "256",
                               "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("density    64 texels per unit of usemtl wood\n"), std::string::npos)
      << outcome.out;
  const Json layout = Json::parse(directory.read("r.json"))["layout"];
  ASSERT_EQ(layout["charts"].size(), 2);
  EXPECT_EQ(layout["charts"][0]["first_face"], 0);
  EXPECT_NEAR(layout["charts"][0]["texels_per_unit"], 64, 1e-9);
  EXPECT_NEAR(layout["charts"][1]["texels_per_unit"], 32, 1e-9);
  EXPECT_NEAR(layout["charts"][1]["area"], 4, 1e-9);
  ASSERT_EQ(layout["labels"].size(), 2);
  EXPECT_EQ(layout["labels"][1]["name"], "usemtl brass");
  EXPECT_NEAR(layout["labels"][1]["texels_per_unit"], 32, 1e-9);
  EXPECT_EQ(run({"check", in, "--labels", "groups"}).exit_code, 2);
  EXPECT_EQ(run({"check", in, "--labels", "material", "--resolution", "256"}).out.substr(0, 300),
            outcome.out.substr(0, 300));
}

// One triangle, which the second set of UVs turns over.
TEST(Check, JudgesTheSetOfUvsThatIsAsked) {
  const TemporaryDirectory directory;
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                {"TEXCOORD_0", builder.vectors2({0, 1, 1, 1, 0, 0})},
                {"TEXCOORD_1", builder.vectors2({0, 1, 0, 0, 1, 1})}})["material"] = 0;
  builder.json["materials"] = GltfBuilder::Json::array({GltfBuilder::Json::object()});
  const std::string in = directory.file("in.glb", builder.glb()), report = directory.path("r.json");
  EXPECT_EQ(run({"check", in}).exit_code, 0);
  const Outcome second = run({"check", in, "--uv-set", "1", "--report", report});
  EXPECT_EQ(second.exit_code, 3);
  EXPECT_NE(second.out.find("NO: 1 flipped"), std::string::npos) << second.out;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["options"]["uv-set"], "1");
  const Outcome third = run({"check", in, "--uv-set", "2"});
  EXPECT_EQ(third.exit_code, 2);
  EXPECT_NE(third.err.find("has no texture coordinates, TEXCOORD_2"), std::string::npos)
      << third.err;
  const Outcome obj = run({"check", directory.file("in.obj", kSquareWithUvs), "--uv-set", "1"});
  EXPECT_NE(obj.err.find("has one set of UVs"), std::string::npos) << obj.err;
  EXPECT_EQ(run({"check", in, "--labels", "materials"}).exit_code, 0);
}

TEST(Check, FailsWhereUvsAreNotAsAsked) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", two_squares("0")),
                    tile = directory.file("tile.obj", two_squares("3"));
  EXPECT_EQ(run({"check", in, "--within-page", "--within-tiles", "--margin", "102.4"}).exit_code,
            0);
  EXPECT_EQ(run({"check", in, "--margin", "102.5"}).exit_code, 3);
  EXPECT_EQ(run({"check", tile, "--within-tiles"}).exit_code, 0);
  const Outcome outside = run({"check", tile, "--within-page"});
  EXPECT_EQ(outside.exit_code, 3);
  EXPECT_NE(outside.out.find("unmet      --within-page: 2 charts"), std::string::npos)
      << outside.out;
  const std::string beyond = directory.file(
      "beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1.185 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  EXPECT_EQ(run({"check", beyond}).exit_code, 0);
  EXPECT_EQ(run({"check", beyond, "--within-page"}).exit_code, 3);
  EXPECT_EQ(run({"check", beyond, "--within-tiles"}).exit_code, 3);
  EXPECT_EQ(run({"check", beyond, "--margin", "1"}).exit_code, 3);
}

TEST(Check, AgreesWithThePackerOnItsMargin) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", torus_with_hole(12)),
                    out = directory.path("out.obj");
  ASSERT_EQ(run({"unwrap", in, out, "--cut", "minimal", "--resolution", "256", "--margin", "3",
                 "--report", directory.path("u.json")})
                .exit_code,
            0);
  EXPECT_EQ(run({"check", out, "--resolution", "256", "--margin", "3", "--within-page", "--report",
                 directory.path("c.json")})
                .exit_code,
            0);
  const Json packing = Json::parse(directory.read("u.json"))["packing"],
             layout = Json::parse(directory.read("c.json"))["layout"];
  EXPECT_NEAR(layout["margin"], packing["margin"], 1e-6);
}

TEST(Check, RefusesWhatItCannotJudge) {
  const TemporaryDirectory directory;
  const std::string nan_uv = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt nan 1\nf 1/1 2/2 3/3\n";
  for (const auto& [what, text, word] : {std::tuple<std::string, std::string, std::string>{
                                             "no UVs", kSquare, "no texture coordinates"},
                                         {"NaN", nan_uv, "vertex 2"}}) {
    const std::string in = directory.file("in.obj", text);
    const Outcome outcome = run({"check", in});
    EXPECT_EQ(outcome.exit_code, 2) << what;
    EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("beltrami: " + in + ": ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run({"check", directory.file("in.stl", "solid\nendsolid\n")}).exit_code, 2);
  EXPECT_EQ(run({"check", directory.path("none.obj")}).exit_code, 2);
}

}  // namespace
}  // namespace beltrami::cli
