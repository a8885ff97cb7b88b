// beltrami flatten, end to end.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "files/mesh_file.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

TEST(Flatten, WritesAnInjectiveMapThatCheckConfirms) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(6)), out = directory.path("out.obj");
  const Outcome flattened = run({"flatten", in, out});
  EXPECT_EQ(flattened.exit_code, 0) << flattened.err;
  EXPECT_EQ(flattened.err, "") << "no progress bar without a terminal";
  EXPECT_NE(flattened.out.find("injective  yes"), std::string::npos) << flattened.out;
  EXPECT_EQ(run({"check", out}).exit_code, 0);

  const MeshFile before = read_mesh(in, Content::kSurface), after = read_mesh(out, Content::kUvs);
  EXPECT_EQ(before.positions, after.positions) << "every bit, and the order";
  EXPECT_EQ(before.polygons.corners(), after.polygons.corners());
}

TEST(Flatten, QuietPrintsNothing) {
  const TemporaryDirectory directory;
  const Outcome outcome =
      run({"flatten", directory.file("in.obj", kSquare), directory.path("out.ply"), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST(Flatten, MayWriteOverItsInput) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.obj", kSquare);
  EXPECT_EQ(run({"flatten", path, path}).exit_code, 0);
  EXPECT_EQ(read_mesh(path, Content::kUvs).vertex_count(), 4u);
  EXPECT_EQ(directory.names().size(), 1u);
}

TEST(Flatten, EveryFormatGivesTheSameBits) {
  const TemporaryDirectory directory;
  const std::string off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0.25\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0.25\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  const std::string stl =
      "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0.25\n"
      "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 1 0.25\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  std::vector<double> expected;
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.obj", kSquare},
                                   {"a.off", off},
                                   {"a.ply", ply},
                                   {"a.stl", stl}}) {
    for (const std::string extension : {".obj", ".ply"}) {
      const std::string out = directory.path("out_" + name + extension);
      const Outcome outcome = run({"flatten", directory.file(name, text), out});
      ASSERT_EQ(outcome.exit_code, 0) << name << outcome.err;
      const std::vector<double> uvs = read_mesh(out, Content::kUvs).uvs;
      if (expected.empty()) expected = uvs;
      ASSERT_EQ(uvs.size(), expected.size());
      EXPECT_EQ(std::memcmp(uvs.data(), expected.data(), uvs.size() * sizeof(double)), 0) << name;
    }
  }
}

TEST(Flatten, FitsTheUnitSquareOnRequest) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(20)), out = directory.path("out.obj");
  ASSERT_EQ(run({"flatten", in, out, "--unit-square"}).exit_code, 0);
  for (const double value : read_mesh(out, Content::kUvs).uvs) {
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1);
  }
}

TEST(Flatten, ReportsEveryKey) {
  const TemporaryDirectory directory;
  const std::string report = directory.path("r.json");
  const Outcome outcome =
      run({"flatten", directory.file("in.obj", grid(4)), directory.path("out.obj"), "--report",
           report, "--picture", directory.path("p.png"), "--method", "tutte"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(directory.read("p.png").substr(1, 3), "PNG");
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["status"], "BELTRAMI_OK");
  EXPECT_EQ(json["command"], "flatten");
  EXPECT_TRUE(json["message"].is_null() && json["element"].is_null());
  EXPECT_EQ(json["input"]["vertices"], 25);
  EXPECT_EQ(json["input"]["faces"], 32);
  EXPECT_EQ(json["input"]["boundary_edges"], 16);
  EXPECT_EQ(json["input"]["unreferenced_vertices"], 0);
  EXPECT_GT(json["input"]["area"], 0.0);
  EXPECT_EQ(json["options"]["method"], "tutte");
  EXPECT_EQ(json["injective"]["result"], true);
  EXPECT_EQ(json["injective"]["positive"], 32);
  EXPECT_EQ(json["injective"]["float32"], true);
  EXPECT_GE(json["energy"]["symmetric_dirichlet"], 2.0);
  EXPECT_EQ(json["energy"]["left_out"], 0);
  EXPECT_EQ(json["stages"].front()["name"], "read");
  EXPECT_EQ(json["stages"].back()["name"], "picture");
  for (const char* key : {"version", "coarse_faces", "flips_before_repair", "seconds",
                          "peak_memory_bytes", "estimated_memory_bytes", "threads"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST(Flatten, StaysWithinAMemoryLimitOrSaysWhatItNeeds) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(6)), out = directory.path("out.obj");
  const std::string report = directory.path("r.json");
  const Outcome refused = run({"flatten", in, out, "--memory-limit", "1M", "--report", report});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.err.find("memory-limit allows 1 MiB"), std::string::npos) << refused.err;
  EXPECT_EQ(directory.names().size(), 2u) << "an output was written";
  const Json json = Json::parse(directory.read("r.json"));
  EXPECT_EQ(json["status"], "BELTRAMI_E_OUT_OF_MEMORY");
  EXPECT_EQ(json["options"]["memory-limit"], 1 << 20);
  EXPECT_GT(json["estimated_memory_bytes"], 1 << 20);

  const Outcome flattened = run({"flatten", in, out, "--memory-limit", "1G"});
  EXPECT_EQ(flattened.exit_code, 0) << flattened.err;
  EXPECT_NE(flattened.out.find("MiB"), std::string::npos) << flattened.out;
}

TEST(Flatten, TakesOnlyAsManyThreadsOfItsOwnAccordAsAMemoryLimitHasRoomFor) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(60));
  const auto flatten = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"flatten", in, directory.path("out.obj"), "--flatten", "dirichlet",
                               "--report", directory.path("r.json")});
    const int code = run(more).exit_code;
    return std::pair(code, Json::parse(directory.read("r.json")));
  };
  const Json one = flatten({"--threads", "1"}).second;
  const std::string limit = std::to_string(one["estimated_memory_bytes"].get<std::uint64_t>());
  EXPECT_EQ(flatten({"--threads", "1", "--memory-limit", limit}).first, 0);
  EXPECT_EQ(flatten({"--threads", "64", "--memory-limit", limit}).first, 4) << "the user's wish";
  const auto [code, own] = flatten({"--memory-limit", limit});
  EXPECT_EQ(code, 0);
  EXPECT_EQ(own["threads"], own["options"]["threads"]);
  EXPECT_LE(own["estimated_memory_bytes"], one["estimated_memory_bytes"]);
}

TEST(Flatten, WithOnlyOneIterationIsStillInjective) {
  const TemporaryDirectory directory;
  const Outcome outcome = run({"flatten", directory.file("in.obj", grid(12)),
                               directory.path("out.obj"), "--method", "cm", "--max-iterations", "1",
                               "--tolerance", "0", "--report", directory.path("r.json")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["status"], "BELTRAMI_NOT_CONVERGED");
}

struct Broken {
  const char* what;
  std::string text;
  const char* status;
  const char* kind;  ///< of the element, or ""
};

std::vector<Broken> broken_meshes() {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string six = three + "v 5 0 0\nv 6 0 0\nv 5 1 0\n";
  std::string annulus;
  for (int ring = 1; ring <= 2; ++ring) {
    for (int i = 0; i < 4; ++i) {
      annulus += "v " + std::to_string(i % 2 ? 0 : ring * (1 - i)) + " " +
                 std::to_string(i % 2 ? ring * (2 - i) : 0) + " 0\n";
    }
  }
  for (int i = 0; i < 4; ++i) {
    const int a = i + 1, b = (i + 1) % 4 + 1;
    annulus += "f " + std::to_string(a) + " " + std::to_string(a + 4) + " " +
               std::to_string(b + 4) + "\nf " + std::to_string(a) + " " + std::to_string(b + 4) +
               " " + std::to_string(b) + "\n";
  }
  return {
      {"index range", three + "f 1 2 4\n", "BELTRAMI_E_INDEX_OUT_OF_RANGE", "face"},
      {"NaN", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "BELTRAMI_E_NON_FINITE", "vertex"},
      {"repeated vertex", three + "f 1 2 2\n", "BELTRAMI_E_REPEATED_VERTEX", "face"},
      {"non-manifold edge", three + "v 0 0 1\nv 0 0 -1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n", nullptr,
       "face"},
      {"non-manifold vertex", six + "v 0 -1 0\nf 1 2 3\nf 1 4 5\n",
       "BELTRAMI_E_NON_MANIFOLD_VERTEX", "vertex"},
      {"orientation", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n",
       "BELTRAMI_E_ORIENTATION", "face"},
      {"components", six + "f 1 2 3\nf 4 5 6\n", "BELTRAMI_E_COMPONENTS", "face"},
      {"closed", kTetrahedron, "BELTRAMI_E_CLOSED", ""},
      {"two boundaries", annulus, "BELTRAMI_E_BOUNDARIES", "vertex"},
      {"genus", torus_with_hole(6), "BELTRAMI_E_GENUS", ""},
      {"zero area", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "BELTRAMI_E_ZERO_AREA", ""},
      {"two corners", three + "f 1 2\n", "FILE_ERROR", ""},
      {"quad that repeats a vertex", three + "v 1 1 0\nf 1 2 4 2\n", "BELTRAMI_E_REPEATED_VERTEX",
       "face"},
      {"empty", "", "FILE_ERROR", ""},
      {"no faces", three, "FILE_ERROR", ""},
      {"garbage",
       "\x7f"
       "ELF garbage",
       "FILE_ERROR", ""},
      {"bad number", "v 0 0 zero\n", "FILE_ERROR", ""},
  };
}

TEST(Flatten, RefusesEveryBrokenMeshInOneLine) {
  for (const Broken& broken : broken_meshes()) {
    SCOPED_TRACE(broken.what);
    const TemporaryDirectory directory;
    const std::string in = directory.file("in.obj", broken.text);
    const std::string out = directory.file("out.obj", "precious");
    const Outcome outcome = run({"flatten", in, out, "--report", directory.path("r.json")});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("beltrami: " + in + ": ", 0), 0u) << outcome.err;
    EXPECT_EQ(directory.read("out.obj"), "precious");
    EXPECT_EQ(directory.names().size(), 3u) << "a temporary is left";

    const Json json = Json::parse(directory.read("r.json"));
    if (broken.status) {
      EXPECT_EQ(json["status"], broken.status);
    }
    EXPECT_NE(json["message"], "");
    EXPECT_TRUE(json["injective"].is_null());
    if (*broken.kind) {
      EXPECT_EQ(json["element"]["kind"], broken.kind);
      EXPECT_TRUE(json["element"]["index"].is_number());
      EXPECT_NE(outcome.err.find("counted from 0"), std::string::npos) << outcome.err;
    }
  }
}

TEST(Flatten, RefusesUnusableFiles) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare), out = directory.path("out.obj");
  const std::string truncated = directory.file(
      "t.ply",
      "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty double x\n"
      "property double y\nproperty double z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n\1\2\3");
  const std::vector<std::vector<std::string>> calls = {
      {"flatten", directory.path("none.obj"), out},
      {"flatten", directory.path(""), out},
      {"flatten", truncated, out},
      {"flatten", directory.file("in.xyz", kSquare), out},
      {"flatten", in, directory.path("out.stl")},
      {"flatten", in, directory.path("none/out.obj")},
      {"flatten", in, out, "--report", directory.path("none/r.json")},
      {"flatten", in, out, "--picture", directory.path("none/p.png")},
      {"flatten", in, out, "--report", out},
      {"flatten", in, out, "--report", in},
  };
  for (const auto& call : calls) {
    const Outcome outcome = run(call);
    EXPECT_EQ(outcome.exit_code, 2) << call[1] << " " << call[2];
    EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(out)) << call[1] << " " << call[2];
  }
  EXPECT_EQ(directory.read("in.obj"), kSquare);
}

TEST(Flatten, NamesTheFileThatAFullDiskCutShort) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryDirectory directory;
  const std::string out = directory.path("out.obj");
  std::filesystem::create_symlink("/dev/full", out);
  const Outcome outcome = run({"flatten", directory.file("in.obj", kSquare), out});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err.rfind("beltrami: " + out, 0), 0u) << outcome.err;
}

TEST(Flatten, SaysWhenMemoryRunsOut) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space than the limit leaves";
#endif
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare);
  std::filesystem::resize_file(in, std::uintmax_t{4} << 30);  // sparse: it takes no room
  Surroundings around;
  around.limits = {{RLIMIT_AS, rlim_t{1} << 30}};
  const Outcome outcome = run({"flatten", in, directory.path("out.obj"), "--report",
                               directory.path("r.json"), "--threads", "1"},
                              around);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
  EXPECT_EQ(Json::parse(directory.read("r.json"))["status"], "BELTRAMI_E_OUT_OF_MEMORY");
}

TEST(Flatten, RefusesOptionsThatWouldHaveNoEffect) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(6)), out = directory.path("out.obj");
  const Outcome refused = run({"flatten", in, out, "--method", "cm", "--flatten", "bff"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("flatten=bff has no effect with method=cm"), std::string::npos)
      << refused.err;
  EXPECT_EQ(directory.names().size(), 1u) << "an output was written";
  EXPECT_EQ(run({"flatten", in, out, "--method", "cm"}).exit_code, 0);
  EXPECT_EQ(run({"flatten", in, out, "--flatten", "bff"}).exit_code, 0);
}

TEST(CommandLine, ErrorsAreOneLineAndHelpIsNone) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare), out = directory.path("out.obj");
  const std::vector<std::vector<std::string>> calls = {{},
                                                       {"fold"},
                                                       {"flatten"},
                                                       {"flatten", in},
                                                       {"flatten", in, out, "--nonsense"},
                                                       {"flatten", in, out, "--method", "magic"},
                                                       {"flatten", in, out, "--threads", "-1"},
                                                       {"flatten", in, out, "--tolerance", "nan"},
                                                       {"flatten", in, out, "third"},
                                                       {"check"}};
  for (const auto& call : calls) {
    const Outcome outcome = run(call);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
  }
  for (const auto& call : std::vector<std::vector<std::string>>{
           {"--help"}, {"--version"}, {"flatten", "--help"}, {"check", "--help"}}) {
    const Outcome outcome = run(call);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_NE(run({"flatten", "--help"}).out.find("--coarse-faces"), std::string::npos);
}

}  // namespace
}  // namespace beltrami::cli
