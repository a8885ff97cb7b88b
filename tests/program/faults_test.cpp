// Allocations that fail, one by one and from one on; what reaches the disk in which order, and what
// is there when a rename fails. By libraries that are loaded before the program's own.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/gltf_file.h"
#include "files/mesh_file.h"
#include "gltf_builder.h"
#include "picture/stb_in_one_place.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

/// A command of which every allocation is to fail.
struct Command {
  const char* name;
  std::vector<std::string> arguments;  ///< in.obj, out.obj and the like are files of the test
  long step;                           ///< between the allocations that fail

  friend void PrintTo(const Command& command, std::ostream* out) { *out << command.name; }
};

class OutOfMemory : public testing::TestWithParam<Command> {
 protected:
  Outcome run_in(const TemporaryDirectory& directory, Surroundings around) const {
    std::vector<std::string> arguments = GetParam().arguments;
    for (std::string& argument : arguments) {
      if (argument.find('.') != std::string::npos) argument = directory.path(argument);
    }
    directory.file("in.obj", kSquareWithUvs);
    directory.file("out.obj", "precious");
    directory.file("textured.obj", "mtllib m.mtl\nusemtl a\n" + kSquareWithUvs);
    directory.file("m.mtl", "newmtl a\nmap_Kd t.png\n");
    const std::vector<std::uint8_t> texels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    directory.file("t.png", png_bytes(2, 2, 3, texels.data()));
    around.environment.emplace_back("LD_PRELOAD", BELTRAMI_FAIL_ALLOCATIONS);
    return run(arguments, around);
  }

  long count_allocations() const {
    const TemporaryDirectory directory;
    Surroundings around;
    around.environment = {{"COUNT_TO", directory.path("count")}};
    EXPECT_EQ(run_in(directory, around).exit_code, 0);
    return std::stol(directory.read("count"));
  }

  bool writes(const std::string& name) const {
    const auto& arguments = GetParam().arguments;
    return std::find(arguments.begin(), arguments.end(), name) != arguments.end();
  }

  void expect_a_clean_end(long at, bool later_ones_too) const {
    SCOPED_TRACE(testing::Message() << "allocation " << at << (later_ones_too ? " and on" : ""));
    const TemporaryDirectory directory;
    Surroundings around;
    around.environment = {{"FAIL_AT", std::to_string(at)}};
    if (later_ones_too) around.environment.emplace_back("FAIL_ON", "1");
    const Outcome outcome = run_in(directory, around);
    EXPECT_FALSE(has_temporary(directory));
    if (outcome.exit_code == 0) {  // a library had a way round
      EXPECT_EQ(outcome.err, "");
      EXPECT_EQ(directory.read("out.obj") != "precious", writes("out.obj"));
      if (writes("r.json")) {
        EXPECT_EQ(nlohmann::json::parse(directory.read("r.json"))["status"], "BELTRAMI_OK");
      }
      return;
    }
    EXPECT_EQ(outcome.exit_code, 4) << outcome.signal << outcome.err;
    EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(directory.read("out.obj"), "precious");
  }
};

TEST_P(OutOfMemory, EndsWithOneLineAndLeavesNothing) {
  if (beltrami_has("gpl")) GTEST_SKIP() << "what CHOLMOD links ends the process where memory does";
  const long count = count_allocations();
  ASSERT_GT(count, 100);
  for (long at = 1; at <= count; at += GetParam().step) {
    expect_a_clean_end(at, false);
    expect_a_clean_end(at, true);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Commands, OutOfMemory,
    testing::Values(
        Command{"check", {"check", "in.obj", "--report", "r.json"}, 5},
        Command{
            "flatten", {"flatten", "in.obj", "out.obj", "--report", "r.json", "--threads", "1"}, 3},
        Command{"picture", {"check", "in.obj", "--report", "r.json", "--picture", "p.png"}, 499},
        Command{"unwrap",
                {"unwrap", "in.obj", "out.obj", "--report", "r.json", "--threads", "1",
                 "--resolution", "32", "--cut", "minimal"},
                449},
        Command{"search",
                {"unwrap", "in.obj", "out.obj", "--report", "r.json", "--threads", "1",
                 "--resolution", "32", "--html", "page.html", "--masks", "mask.png"},
                997},
        Command{"pack",
                {"pack", "in.obj", "out.obj", "--report", "r.json", "--threads", "1",
                 "--resolution", "32"},
                449},
        Command{"bake",
                {"unwrap", "textured.obj", "out.obj", "--report", "r.json", "--threads", "1",
                 "--resolution", "32", "--cut", "minimal", "--bake"},
                499},
        Command{"merge",
                {"unwrap", "textured.obj", "new.glb", "--report", "r.json", "--threads", "1",
                 "--resolution", "32", "--cut", "minimal", "--bake", "--merge-materials"},
                499},
        Command{"transfer",
                {"transfer", "in.obj", "textured.obj", "t.png", "o.png", "--resolution", "8"},
                197}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Disk, HasEveryFileBeforeTheFirstIsReplacedAndEveryNameAtTheEnd) {
  const TemporaryDirectory directory, log;
  Surroundings around;
  around.environment = {{"LD_PRELOAD", BELTRAMI_LOG_SYNCS}, {"LOG_TO", log.path("log")}};
  ASSERT_EQ(run({"flatten", directory.file("in.obj", kSquare), directory.path("out.obj"),
                 "--report", directory.path("r.json"), "--picture", directory.path("p.png")},
                around)
                .exit_code,
            0);
  const std::string folder = std::filesystem::path(directory.path("x")).parent_path().string();
  std::vector<std::string> stored, renamed;
  bool named = true;
  std::istringstream lines(log.read("log"));
  for (std::string what, from, line; lines >> what >> from && std::getline(lines, line);) {
    if (what == "sync" && from == folder) {
      named = true;
    } else if (what == "sync") {
      EXPECT_TRUE(renamed.empty()) << from << " is stored after a file was replaced";
      stored.push_back(from);
    } else {
      renamed.push_back(from);
      named = false;
    }
  }
  EXPECT_EQ(stored, renamed);
  EXPECT_EQ(renamed.size(), 3u);
  EXPECT_TRUE(named) << "the folder is not stored after the last rename";
}

/// A .gltf file whose buffer is beside it.
struct Pair {
  TemporaryDirectory directory;
  GltfBuilder builder;
  std::string path;

  Pair() {
    builder.mesh({{"POSITION", builder.vectors3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}},
                 builder.indices<std::uint8_t>({0, 1, 2, 0, 2, 3}));
    directory.file("m.bin", builder.buffer());
    path = directory.file("m.gltf", builder.text("m.bin"));
  }
  std::size_t files() const {
    const auto folder = std::filesystem::path(path).parent_path();
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
  }
  bool has_uvs() const { return !gltf_uvs(read_mesh(path, Content::kSurface), 0).empty(); }
};

Surroundings failing_rename(const char* at, bool kill) {
  Surroundings around;
  around.environment = {{"LD_PRELOAD", BELTRAMI_FAIL_RENAMES}, {"FAIL_AT", at}};
  if (kill) around.environment.emplace_back("KILL", "1");
  return around;
}

TEST(Disk, HasTheOldModelOrTheNewOneWhicheverRenameFails) {
  for (const char* at : {"1", "2"}) {
    const Pair pair;
    const Outcome outcome =
        run({"unwrap", pair.path, pair.path, "--cut", "minimal"}, failing_rename(at, false));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_FALSE(pair.has_uvs()) << "rename " << at;
    EXPECT_EQ(pair.directory.read("m.gltf"), pair.builder.text("m.bin"));
    EXPECT_EQ(pair.directory.read("m.bin"), pair.builder.buffer());
    EXPECT_EQ(pair.files(), 2u) << "nothing is left of the new one";
  }
  const Pair pair;
  const Outcome outcome = run({"unwrap", pair.path, pair.path, "--cut", "minimal"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(pair.has_uvs());
  EXPECT_EQ(pair.files(), 2u) << "nothing is left of the old one";
}

TEST(Disk, HasTheOldModelOrTheNewOneWheneverTheProcessIsKilled) {
  for (const char* at : {"1", "2"}) {
    const Pair pair;
    const Outcome outcome =
        run({"unwrap", pair.path, pair.path, "--cut", "minimal"}, failing_rename(at, true));
    EXPECT_EQ(outcome.signal, SIGKILL);
    EXPECT_FALSE(pair.has_uvs()) << "rename " << at;
    EXPECT_EQ(run({"unwrap", pair.path, pair.path, "--cut", "minimal"}).exit_code, 0);
    EXPECT_TRUE(pair.has_uvs()) << "what was left beside it is in nobody's way";
  }
}

}  // namespace
}  // namespace beltrami::cli
