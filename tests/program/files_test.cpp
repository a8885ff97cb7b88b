// What flatten and check do with files, end to end: polygons, attributes, vertices to weld.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "files/mesh_file.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

/// A bumpy grid of n x n quads, leaning by `shear`, with a group, a material and a normal.
std::string quads(int n, double shear = 0) {
  std::string text = "mtllib a.mtl\n";
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      char line[96];
      std::snprintf(line, sizeof line, "v %g %d %g\n", i + shear * j, j, 0.25 * ((i + j) % 2));
      text += line;
    }
  }
  text += "vn 0 0 1\ng left\nusemtl red\n";
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1;
      text += "f";
      for (const int corner : {a, a + 1, a + n + 2, a + n + 1}) {
        text.append(" ").append(std::to_string(corner)).append("//1");
      }
      text += "\n";
    }
  }
  return text;
}

/// Each triangle of a grid with vertices of its own.
std::string soup(int n) {
  const MeshFile mesh = read_obj(grid(n), "grid", Content::kSurface);
  std::string vertices, faces;
  for (std::uint64_t i = 0; i < mesh.polygons.size(); ++i) {
    faces += "f";
    for (const std::uint32_t vertex : mesh.polygons[i]) {
      char line[128];
      const double* p = &mesh.positions[3 * std::size_t{vertex}];
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
      vertices += line;
      faces.append(" ").append(std::to_string(std::count(vertices.begin(), vertices.end(), '\n')));
    }
    faces += "\n";
  }
  return vertices + faces;
}

TEST(Files, PolygonsStayPolygonsAndAreCertifiedInTriangles) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", quads(6)), out = directory.path("out.obj");
  const Outcome outcome = run({"flatten", in, out, "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "everything is kept";
  const std::string text = directory.read("out.obj");
  for (const char* kept : {"mtllib a.mtl\n", "g left\n", "usemtl red\n", "vn 0 0 1\n",
                           "f 1/1/1 2/2/1 9/9/1 8/8/1\n"}) {
    EXPECT_NE(text.find(kept), std::string::npos) << kept;
  }
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["input"]["faces"], 36);
  EXPECT_EQ(json["input"]["triangles"], 72);
  EXPECT_EQ(json["injective"]["positive"], 72);
  EXPECT_EQ(json["not_kept"], Json::array());
  EXPECT_EQ(run({"check", out, "--picture", directory.path("p.png")}).exit_code, 0);
}

TEST(Files, AreTheirOwnOutputOnceMore) {
  const TemporaryDirectory directory;
  const std::string once = directory.path("once.obj"), twice = directory.path("twice.obj");
  ASSERT_EQ(run({"flatten", directory.file("in.obj", quads(6)), once}).exit_code, 0);
  ASSERT_EQ(run({"flatten", once, twice}).exit_code, 0);
  EXPECT_EQ(directory.read("once.obj"), directory.read("twice.obj"));
}

TEST(Files, SayInOneLineWhatIsNotKept) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", quads(4)), out = directory.path("out.ply");
  const Outcome outcome = run({"flatten", in, out, "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "beltrami: note: " + out + " does not keep materials, groups\n");
  EXPECT_EQ(Json::parse(directory.read("r.json"))["not_kept"], (Json{"materials", "groups"}));
  EXPECT_EQ(run({"flatten", in, out, "--quiet"}).err, "");
}

TEST(Files, FlippedTrianglesTakeThePlaceOfPolygons) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", quads(12, 2)), out = directory.path("out.obj");
  const Outcome outcome = run({"flatten", in, out, "--delaunay", "on", "--coarse-faces", "60",
                               "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(directory.read("r.json"));
  ASSERT_GT(json["repair"]["delaunay_flips"], 0) << "the test needs a mesh that is not Delaunay";
  EXPECT_EQ(outcome.err_lines(), 1);
  EXPECT_NE(outcome.err.find("does not keep polygons, normals of corners, groups"),
            std::string::npos)
      << outcome.err;
  EXPECT_TRUE(read_mesh(out, Content::kUvs).polygons.all_triangles());
  EXPECT_EQ(run({"check", out}).exit_code, 0);
}

TEST(Files, FailuresNameTheFaceOfTheFile) {
  const TemporaryDirectory directory;
  const std::string in =
      directory.file("in.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0\n"
                     "f 1 2 3 4\nf 5 6 7 8\n");
  const Outcome outcome =
      run({"flatten", in, directory.path("out.obj"), "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("face 1 is not connected to face 0"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("--weld"), std::string::npos) << "it would not help";
  EXPECT_EQ(Json::parse(directory.read("r.json"))["element"]["index"], 1);
}

TEST(Weld, IsOfferedWhereItHelps) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", soup(4)), out = directory.path("out.obj");
  const Outcome refused = run({"flatten", in, out});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err_lines(), 1) << refused.err;
  EXPECT_NE(refused.err.find("--weld"), std::string::npos) << refused.err;

  const Outcome welded = run({"flatten", in, out, "--weld", "--report", directory.path("r.json")});
  EXPECT_EQ(welded.exit_code, 0) << welded.err;
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["input"]["vertices"], 96);
  EXPECT_EQ(json["input"]["welded_vertices"], 96 - 25);
  EXPECT_EQ(json["input"]["unreferenced_vertices"], 0);
  EXPECT_EQ(json["options"]["weld"], true);
}

TEST(Weld, GivesVerticesAtOnePlaceOneUv) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", soup(4)), out = directory.path("out.obj");
  ASSERT_EQ(run({"flatten", in, out, "--weld"}).exit_code, 0);
  const MeshFile before = read_mesh(in, Content::kSurface), after = read_mesh(out, Content::kUvs);
  EXPECT_EQ(before.positions, after.positions);
  EXPECT_EQ(before.polygons.corners(), after.polygons.corners());
  std::map<std::array<double, 3>, std::array<double, 2>> uv_at;
  for (std::size_t i = 0; i < after.vertex_count(); ++i) {
    const double* p = &after.positions[3 * i];
    const std::array<double, 2> uv = {after.uvs[2 * i], after.uvs[2 * i + 1]};
    EXPECT_EQ(uv_at.try_emplace({p[0], p[1], p[2]}, uv).first->second, uv);
  }
  EXPECT_EQ(uv_at.size(), 25u);
  // In pieces it is judged as an atlas.
  EXPECT_EQ(run({"check", out}).exit_code, 0);
  EXPECT_EQ(run({"check", out, "--weld"}).exit_code, 0);
  const Outcome unwelded = run({"flatten", in, out});
  EXPECT_EQ(unwelded.exit_code, 2);
  EXPECT_NE(unwelded.err.find("--weld"), std::string::npos) << unwelded.err;
}

}  // namespace
}  // namespace beltrami::cli
