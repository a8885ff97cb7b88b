// beltrami unwrap, end to end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "gltf_builder.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

/// A cube of quads in two materials.
const std::string kCube =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "usemtl red\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nusemtl blue\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

TEST(Unwrap, TakesAClosedMeshAndKeepsItsPolygons) {
  const TemporaryDirectory directory;
  for (const char* name : {"out.obj", "out.ply"}) {
    const std::string in = directory.file("in.obj", kCube), out = directory.path(name);
    const std::string report = directory.path("report.json");
    const Outcome outcome = run({"unwrap", in, out, "--report", report});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("injective  yes"), std::string::npos) << outcome.out;
    EXPECT_EQ(run({"check", out}).exit_code, 0);
    const MeshFile before = read_mesh(in, Content::kSurface), after = read_mesh(out, Content::kUvs);
    EXPECT_EQ(before.positions, after.positions);
    EXPECT_EQ(before.polygons.corners(), after.polygons.corners());
    EXPECT_EQ(after.polygons.size(), 6u);
    EXPECT_EQ(after.corner_uvs.of_corner.size(), 24u);
    const Json json = Json::parse(directory.read("report.json"));
    EXPECT_EQ(json["command"], "unwrap");
    EXPECT_EQ(json["charts"], 1);
    EXPECT_EQ(json["injective"]["result"], true);
    EXPECT_EQ(json["injective"]["overlaps"], 0);
    EXPECT_NEAR(json["admitted"]["area"].get<double>(), 6, 1e-12);
    EXPECT_EQ(json["admitted"]["triangles"], 12);
    EXPECT_GE(json["energy"]["symmetric_dirichlet"], 2);
    EXPECT_GT(json["utilisation"], 0);
  }
}

TEST(Unwrap, PutsAnAtlasIntoGltf) {
  // A tetrahedron, without UVs.
  GltfBuilder builder;
  builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}},
               builder.indices<std::uint8_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.glb", builder.glb()), out = directory.path("out.glb");
  EXPECT_EQ(run({"unwrap", in, out, "--uv-set", "2"}).exit_code, kExitUnusable);
  const Outcome outcome = run({"unwrap", in, out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(run({"check", out}).exit_code, 0);
  ASSERT_EQ(run({"unwrap", out, out, "--uv-set", "1"}).exit_code, 0)
      << "in place, beside the first";
  const MeshFile before = read_mesh(in, Content::kSurface), after = read_mesh(out, Content::kUvs);
  EXPECT_EQ(gltf_uvs(after, 1), after.uvs);
  EXPECT_EQ(after.polygons.size(), 4u);
  EXPECT_GT(after.vertex_count(), before.vertex_count());
  const std::string obj = directory.file("in.obj", kCube);
  EXPECT_EQ(run({"unwrap", obj, directory.path("b.glb")}).exit_code, 0);
}

TEST(Unwrap, SaysThatAMeshTooSmallForItsAreaHasNoSeams) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj",
                                        "v 0 0 0\nv 1e-320 0 0\nv 1e-320 1e-320 0\n"
                                        "v 0 1e-320 0\nf 1 2 3\nf 1 3 4\n");
  const std::string report = directory.path("report.json");
  const Outcome outcome = run({"unwrap", in, directory.path("out.obj"), "--report", report});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("seams of 0 root areas"), std::string::npos) << outcome.out;
  EXPECT_EQ(Json::parse(directory.read("report.json"))["seam_over_root_area"], 0);
}

TEST(Unwrap, WritesTheTrianglesOnDemand) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  ASSERT_EQ(run({"unwrap", in, out, "--triangulate"}).exit_code, 0);
  const MeshFile after = read_mesh(out, Content::kAll);
  EXPECT_EQ(after.polygons.size(), 12u);
  EXPECT_TRUE(after.polygons.all_triangles());
  ASSERT_EQ(after.statements.size(), 3u);
  EXPECT_EQ(after.statements[1].polygon, 0u);
  EXPECT_EQ(after.statements[2].text, "usemtl blue");
  EXPECT_EQ(after.statements[2].polygon, 6u);
  EXPECT_EQ(run({"check", out}).exit_code, 0);
}

TEST(Unwrap, GivesMaterialsTilesOfTheirOwn) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const Outcome outcome = run({"unwrap", in, out, "--labels", "materials", "--label-pages"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("label      1001: usemtl red\nlabel      1002: usemtl blue\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(run({"check", out, "--within-tiles", "--margin", "2"}).exit_code, 0);
  const MeshFile file = read_mesh(out, Content::kUvs);
  for (std::size_t c = 0; c < 24; ++c) {
    const double u = file.corner_uvs.values[2 * file.corner_uvs.of_corner[c]];
    EXPECT_EQ(u > 1, c >= 12) << c;
  }
  const Outcome refused = run({"unwrap", in, out, "--label-pages"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("say by --labels which"), std::string::npos) << refused.err;
}

TEST(Unwrap, CutsAlongMaterialsSeamsAnglesAndIslands) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const auto charts = [&](const std::string& mesh, std::vector<std::string> arguments) {
    const std::vector<std::string> first = {"unwrap", mesh, out, "--report",
                                            directory.path("r.json")};
    arguments.insert(arguments.begin(), first.begin(), first.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(directory.read("r.json"))["charts"].get<int>();
  };
  EXPECT_EQ(charts(in, {"--labels", "materials", "--cut", "given"}), 2);
  const std::string seams = directory.file("seams", "0 2\n2 3\n3 1\n1 0\n");
  EXPECT_EQ(charts(in, {"--seams", seams, "--cut", "given"}), 2);
  const Outcome none = run({"unwrap", in, out, "--seams", directory.file("none", "0 2\n0 7\n")});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_NE(none.err.find("1 of 2 seams join vertices that no face has side by side, the first 0 "
                          "and 7"),
            std::string::npos)
      << none.err;
  EXPECT_EQ(charts(in, {"--hard-angle", "45"}), 6);
  const std::string islands = directory.path("islands.obj");
  ASSERT_EQ(run({"unwrap", in, islands, "--hard-angle", "45"}).exit_code, 0);
  EXPECT_EQ(charts(islands, {"--cut", "islands"}), 6);
  EXPECT_EQ(charts(islands, {"--cut", "minimal"}), 1);
}

TEST(Unwrap, SeamsThatAreWrittenMakeTheSameCharts) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const std::string seams = directory.path("seams"), report = directory.path("r.json");
  ASSERT_EQ(run({"unwrap", in, out, "--write-seams", seams, "--report", report}).exit_code, 0);
  const std::string written = directory.read("seams");
  const Json first = Json::parse(directory.read("r.json"));
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), first["seams"].get<int>());
  ASSERT_EQ(run({"unwrap", in, out, "--seams", seams, "--cut", "given", "--write-seams", seams,
                 "--report", report})
                .exit_code,
            0)
      << "in place";
  EXPECT_EQ(directory.read("seams"), written);
  const Json second = Json::parse(directory.read("r.json"));
  EXPECT_EQ(second["charts"], first["charts"]);
  EXPECT_TRUE(second["target"].is_null());
}

// The list of none was refused, with all the work done.
TEST(Unwrap, WritesAnEmptyListWhereThereAreNoSeams) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string seams = directory.path("seams.txt");
  const Outcome outcome = run({"unwrap", in, directory.path("out.obj"), "--write-seams", seams});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(directory.read("seams.txt"), "");
}

TEST(Unwrap, NamesChartsOnWhichNothingCanBePainted) {
  const TemporaryDirectory directory;
  const std::string in = directory.file(
      "in.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2.0001 0 0\nv 2.0001 0.0001 0\n"
      "f 1 2 3 4\nf 5 6 7\n");
  const std::string report = directory.path("r.json");
  const Outcome outcome = run({"unwrap", in, directory.path("out.obj"), "--report", report});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\nnote       1 chart has less than 4 texels: raise --resolution\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["packing"]["tiny_charts"], 1);
}

TEST(Unwrap, SplitsChartsAtAPrice) {
  const TemporaryDirectory directory;
  std::string strip;
  for (int i = 0; i <= 24; ++i) {
    strip += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\n";
  }
  for (int i = 1; i < 49; i += 2) {
    strip += "f " + std::to_string(i) + " " + std::to_string(i + 2) + " " + std::to_string(i + 3) +
             " " + std::to_string(i + 1) + "\n";
  }
  const std::string in = directory.file("in.obj", strip), out = directory.path("out.obj");
  const std::string seams = directory.path("seams"), report = directory.path("r.json");
  const Outcome outcome =
      run({"unwrap", in, out, "--fill-weight", "20", "--write-seams", seams, "--report", report});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\nsplits "), std::string::npos) << outcome.out;
  const Json json = Json::parse(directory.read("r.json"));
  const Json& packing = json["packing"];
  EXPECT_GT(packing["splits"], 0);
  EXPECT_EQ(json["charts"], 1 + packing["splits"].get<int>());
  EXPECT_GE(
      20 * (packing["utilisation"].get<double>() - packing["unsplit_utilisation"].get<double>()),
      packing["split_length"].get<double>());
  EXPECT_EQ(json["seams"], packing["splits"]) << "an edge each";
  EXPECT_EQ(run({"check", out}).exit_code, 0);
  ASSERT_EQ(
      run({"unwrap", in, out, "--seams", seams, "--cut", "given", "--report", report}).exit_code,
      0);
  EXPECT_EQ(Json::parse(directory.read("r.json"))["charts"], json["charts"]);
  const Outcome refused = run({"unwrap", in, out, "--fill-weight", "20", "--pack", "none"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("fill-weight=20 has no effect with pack=none"), std::string::npos);
}

TEST(Unwrap, SaysWhetherTheTargetIsReached) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const std::string report = directory.path("r.json");
  Outcome outcome = run({"unwrap", in, out, "--report", report});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("target     reached: 2.05 mean\n"), std::string::npos) << outcome.out;
  Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["target"]["energy"], 2.05);
  EXPECT_EQ(json["target"]["reached"], true);
  outcome = run({"unwrap", in, out, "--seam-budget", "0.01", "--report", report});
  ASSERT_EQ(outcome.exit_code, 0) << "no error: " << outcome.err;
  EXPECT_NE(
      outcome.out.find(
          "target     MISSED by the mean and the seams: 2.05 mean, seams up to 0.01 root areas\n"),
      std::string::npos)
      << outcome.out;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["target"]["reached"], false);
}

// Three edges of unit length at a right angle, too small for a density in texels.
TEST(Unwrap, OfATinySurfaceSaysNoDensity) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", "v 0 0 0\nv 1e-320 0 0\nv 0 1e-320 0\nf 1 2 3\n");
  const Outcome outcome = run({"unwrap", in, directory.path("out.obj")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("pages      1"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("inf per unit"), std::string::npos) << outcome.out;
}

// Flat normals give glTF a vertex for each corner of the tetrahedron; the file has four.
TEST(Unwrap, ToGltfCountsTheVerticesOfTheInput) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kTetrahedron + "v 9 9 9\n");
  const std::string report = directory.path("r.json");
  ASSERT_EQ(run({"unwrap", in, directory.path("out.glb"), "--report", report}).exit_code, 0);
  const Json gltf = Json::parse(directory.read("r.json"));
  ASSERT_EQ(run({"unwrap", in, directory.path("out.obj"), "--report", report}).exit_code, 0);
  const Json obj = Json::parse(directory.read("r.json"));
  EXPECT_EQ(gltf["input"]["vertices"], 5);
  EXPECT_EQ(gltf["input"], obj["input"]);
  EXPECT_EQ(gltf["admitted"]["welded_vertices"], 0);
  EXPECT_EQ(gltf["admitted"]["unused_vertices"], 1);
}

TEST(Unwrap, APresetSetsWhatIsNotGiven) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const auto options = [&](std::vector<std::string> arguments) {
    const std::vector<std::string> first = {"unwrap", in, out, "--report",
                                            directory.path("r.json")};
    arguments.insert(arguments.begin(), first.begin(), first.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    return Json::parse(directory.read("r.json"))["options"];
  };
  EXPECT_EQ(options({})["target-energy"], 2.05);
  const Json lightmap = options({"--target-energy", "2.2", "--preset", "lightmap"});
  EXPECT_EQ(lightmap["preset"], "lightmap");
  EXPECT_EQ(lightmap["target-energy"], 2.2);
  EXPECT_EQ(lightmap["hidden-seams"], 0);
  EXPECT_EQ(run({"unwrap", in, out, "--cut", "minimal", "--preset", "lightmap"}).exit_code,
            kExitUnusable);
}

TEST(Unwrap, TakesPaintAndMaterials) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const auto with_paint = [&](const std::string& text) {
    return run(
        {"unwrap", in, out, "--materials", "materials", "--paint", directory.file("paint", text)});
  };
  const Outcome outcome = with_paint("# away from here\nv 0 10\n\ne 2 3 0.1 # but here\r\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto expect = [&](const std::string& text, const std::string& message) {
    const Outcome refused = with_paint(text);
    EXPECT_EQ(refused.exit_code, kExitUnusable);
    EXPECT_NE(refused.err.find(message), std::string::npos) << refused.err;
  };
  expect("v 0 1\nw 0 1\n", "line 2: 'w' is no paint");
  expect("v 8 1\n", "there is no vertex 8: there are 8");
  expect("e 0 1\n", "factor is missing");
  expect("v 0 -1\n", "0 or more");
  expect("v 0 inf\n", "");
  expect("v 0 1 1\n", "one");
  const Outcome refused = run({"unwrap", in, out, "--materials", "objects"});
  EXPECT_EQ(refused.exit_code, kExitUnusable);
  EXPECT_NE(refused.err.find("no objects to draw seams (--materials)"), std::string::npos)
      << refused.err;
}

/// A grid of 2 x 2 quads in a plane.
const std::string kGrid =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n"
    "f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n";

TEST(Unwrap, HoldsPins) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kGrid), out = directory.path("out.obj");
  const std::string pins = directory.file(
      "pins", "# the corners\nv 0 0.1 0\nc 5 2.25 0\n\nv 8 2 2.5  # the last one\r\nv 4 1 1.25\n");
  const Outcome outcome = run({"unwrap", in, out, "--pins", pins});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const MeshFile mesh = read_mesh(out, Content::kUvs);
  const auto uv = [&](std::size_t corner) {
    const auto& [values, of_corner] = mesh.corner_uvs;
    const std::vector<double>& uvs = of_corner.empty() ? mesh.uvs : values;
    const std::size_t i = of_corner.empty() ? mesh.polygons.corners()[corner] : of_corner[corner];
    return std::pair(uvs[2 * i], uvs[2 * i + 1]);
  };
  EXPECT_EQ(uv(0), std::pair(0.1, 0.0));
  EXPECT_EQ(uv(5), std::pair(2.25, 0.0));
  EXPECT_EQ(uv(14), std::pair(2.0, 2.5));
  for (const std::size_t corner : {2, 7, 9, 12}) EXPECT_EQ(uv(corner), std::pair(1.0, 1.25));
}

TEST(Unwrap, NamesThePinThatIsWrong) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kGrid), out = directory.path("out.obj");
  const auto error = [&](const std::string& pins) {
    const Outcome outcome = run({"unwrap", in, out, "--pins", directory.file("pins", pins)});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.err_lines(), 1);
    EXPECT_EQ(directory.read("out.obj"), "") << "nothing is written";
    return outcome.err;
  };
  const auto expect = [&](const std::string& pins, const std::string& text) {
    const std::string found = error(pins);
    EXPECT_NE(found.find(text), std::string::npos) << found;
  };
  expect("v 0 0 0\nw 1 0 0\n", "pins: line 2: 'w' is no pin");
  expect("v 0 0\n", "line 1: v is missing");
  expect("v 0 0 0 0\n", "line 1: v of the direction is missing");
  expect("v 0 0 0 0 1 2\n", "one");
  expect("v 9 0 0\n", "line 1: there is no vertex 9: there are 9");
  expect("c 16 0 0\n", "there is no corner 16");
  expect("c -1 0 0\n", "there is no corner -1");
  expect("v 0 0 inf\n", "the pin of line 1 (corner 0) is infinite");
  expect("v 4 0 0\n\nc 7 0 1\n", "the pin of line 3 (corner 7) is to lie at");
  expect("v 4 0 0\nv 0 1 1\nv 1 0 0\n",
         "the pin of line 3 (corner 1) cannot be met together with those before it");
}

TEST(Unwrap, SaysWhatIsWrong) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCube), out = directory.path("out.obj");
  const auto error = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "unwrap");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.err_lines(), 1);
    EXPECT_EQ(directory.read("out.obj"), "") << "nothing is written";
    return outcome.err;
  };
  EXPECT_NE(error({in, out, "--labels", "colour"}).find("faces have no property 'colour'"),
            std::string::npos);
  EXPECT_NE(error({in, out, "--labels", "groups"}).find("has no groups"), std::string::npos);
  EXPECT_NE(error({in, out, "--seams", directory.file("s", "0 8")}).find("no vertex 8"),
            std::string::npos);
  EXPECT_NE(error({in, out, "--seams", directory.file("s", "0 1 2")}).find("pairs"),
            std::string::npos);
  EXPECT_NE(error({in, out, "--cut", "islands"}).find("no texture coordinates"), std::string::npos);
  EXPECT_NE(error({in, directory.path("out.stl")}).find("OBJ, PLY or glTF"), std::string::npos);
  const std::string flat = directory.file("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_NE(error({flat, out}).find("no area"), std::string::npos);
}

TEST(Unwrap, TakesWhatThereIsOfAFileThatEndsAmidItsFaces) {
  const TemporaryDirectory directory;
  const std::string in = directory.file(
      "in.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0.25\n0 1 0\n3 0 1 2\n3 0 2");
  const std::string out = directory.path("out.obj");
  const Outcome outcome = run({"unwrap", in, out});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("it ends in face 1 (counted from 0) of 3"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(read_mesh(out, Content::kUvs).polygons.size(), 1u);
  EXPECT_EQ(run({"flatten", in, out}).exit_code, 2);
}

TEST(Unwrap, ReadsMniObjects) {
  const TemporaryDirectory directory;
  const std::string head =
      "P 0.3 0.3 0.4 10 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\n0 0 1\n0 0 1\n0 0 1\n0 0 1\n\n2\n"
      "0 1 1 1 1\n\n3 6\n\n";
  const std::string out = directory.path("out.ply");
  EXPECT_EQ(run({"unwrap", directory.file("a.obj", head + "0 1 2 0 2 3\n"), out}).exit_code, 0);
  const MeshFile mesh = read_mesh(out, Content::kAll);
  EXPECT_EQ(mesh.polygons.corners(), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  ASSERT_EQ(mesh.vertex_columns.size(), 3u);
  EXPECT_EQ(mesh.vertex_columns[2][3], 1);
  for (const char* bad : {"0 1 2 0 2 4\n", "0 1 2 0 2\n", "0 1 2 x\n"}) {
    EXPECT_EQ(run({"unwrap", directory.file("a.obj", head + bad), out}).exit_code, 2) << bad;
  }
}

TEST(Unwrap, IsWhatFlattenSaysForAMeshThatIsNoDisk) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kTetrahedron), out = directory.path("out.obj");
  const Outcome refused = run({"flatten", in, out});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("beltrami unwrap"), std::string::npos) << refused.err;
  EXPECT_EQ(run({"unwrap", in, out}).exit_code, 0);
}

TEST(Unwrap, GivesADiskTheBitsOfFlatten) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(6));
  const std::string one = directory.path("one.obj"), other = directory.path("other.obj");
  ASSERT_EQ(run({"flatten", in, one}).exit_code, 0);
  ASSERT_EQ(run({"unwrap", in, other, "--pack", "none"}).exit_code, 0);
  EXPECT_EQ(read_mesh(one, Content::kUvs).uvs, read_mesh(other, Content::kUvs).uvs);
}

TEST(Unwrap, CheckListsWhatOverlaps) {
  const TemporaryDirectory directory;
  // Two squares of a bent strip on each other, with UVs of their own.
  const std::string in = directory.file(
      "in.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
      "f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n");
  const std::string report = directory.path("r.json");
  const Outcome outcome = run({"check", in, "--report", report});
  EXPECT_EQ(outcome.exit_code, 3);
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["injective"]["result"], false);
  EXPECT_GE(json["injective"]["overlaps"], 1);
  EXPECT_EQ(json["injective"]["first_overlap"], (Json{0, 1}));
  EXPECT_NE(outcome.out.find("faces 0 and 1 overlap"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace beltrami::cli
