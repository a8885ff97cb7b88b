// Standard streams that are full, closed or unread, and files that are pipes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "files/mesh_file.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

bool has_full_device() {
  return std::filesystem::is_character_file("/dev/full");
}

/// A square, flattened in `around`: the outcome, and whether the output is whole.
struct Flattened {
  explicit Flattened(const Surroundings& around, const std::vector<std::string>& more = {}) {
    const std::string out = directory.path("out.obj");
    std::vector<std::string> arguments = {"flatten", directory.file("in.obj", kSquare), out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    outcome = run(arguments, around);
    whole = std::filesystem::exists(out) && read_mesh(out, Content::kUvs).uvs.size() == 8 &&
            run({"check", out}).exit_code == 0;
  }
  TemporaryDirectory directory;
  Outcome outcome;
  bool whole = false;
};

void expect_a_lost_summary(const Flattened& run) {
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.outcome.err.rfind("beltrami: standard output: the summary is lost: ", 0), 0u)
      << run.outcome.err;
  EXPECT_EQ(run.outcome.err_lines(), 1);
  EXPECT_TRUE(run.whole) << "the work is kept";
}

TEST(StandardOutput, ThatIsFullFailsAfterTheFilesAreWritten) {
  if (!has_full_device()) GTEST_SKIP() << "no /dev/full here";
  Surroundings around;
  around.out = "/dev/full";
  expect_a_lost_summary(Flattened(around));
  EXPECT_EQ(Flattened(around, {"--quiet"}).outcome.exit_code, 0) << "there is nothing to print";
  EXPECT_EQ(run({"--help"}, around).exit_code, 1);
  EXPECT_EQ(run({"--version"}, around).exit_code, 1);
  const TemporaryDirectory directory;
  const std::string mesh = directory.file("in.obj", kSquareWithUvs);
  EXPECT_EQ(run({"check", mesh, "--report", directory.path("r.json")}, around).exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(directory.read("r.json"))["status"], "BELTRAMI_OK");
}

TEST(StandardOutput, ThatIsClosedFailsAfterTheFilesAreWritten) {
  Surroundings around;
  around.closed = {1};
  expect_a_lost_summary(Flattened(around));
  EXPECT_EQ(Flattened(around, {"--quiet"}).outcome.exit_code, 0);
}

TEST(StandardOutput, ThatNobodyReadsAnyMoreFailsAfterTheFilesAreWritten) {
  const TemporaryDirectory directory;
  Surroundings around;
  around.out = make_pipe(directory, "pipe");
  const int reader = open(around.out.c_str(), O_RDONLY | O_NONBLOCK);
  const std::string in = make_pipe(directory, "in.obj"), out = directory.path("out.obj");
  Program program({"flatten", in, out}, around);
  const int mesh = open(in.c_str(), O_WRONLY);  // the program has begun, and waits
  close(reader);
  ASSERT_EQ(write(mesh, kSquare.data(), kSquare.size()), static_cast<ssize_t>(kSquare.size()));
  close(mesh);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1) << "and not a death by SIGPIPE: " << outcome.signal;
  EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
  EXPECT_EQ(read_mesh(out, Content::kUvs).uvs.size(), 8u);
}

TEST(StandardOutput, MustNotBeAFileThatTheProgramReplaces) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare), report = directory.path("r.json");
  Surroundings around;
  around.out = report;
  const std::vector<std::string> command = {"flatten", in, directory.path("out.obj"), "--report",
                                            report};
  const Outcome refused = run(command, around);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--quiet"), std::string::npos) << refused.err;
  std::vector<std::string> quiet = command;
  quiet.emplace_back("--quiet");
  EXPECT_EQ(run(quiet, around).exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(directory.read("r.json"))["status"], "BELTRAMI_OK");
}

TEST(StandardError, ThatIsFullOrClosedChangesNoExitCode) {
  Surroundings full, closed;
  full.err = "/dev/full";
  closed.closed = {2};
  for (const Surroundings& around : {full, closed}) {
    if (around.closed.empty() && !has_full_device()) continue;
    const Flattened good(around);
    EXPECT_EQ(good.outcome.exit_code, 0);
    EXPECT_TRUE(good.whole);
    const TemporaryDirectory directory;
    const std::string in = directory.file("in.obj", kTetrahedron);
    EXPECT_EQ(run({"flatten", in, directory.path("out.obj")}, around).exit_code, 2);
    EXPECT_EQ(directory.names().size(), 1u);
  }
}

TEST(StandardStreams, ThatAreClosedAreNotTakenForFiles) {
  Surroundings around;
  around.closed = {0, 1, 2};
  const Flattened run(around);
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_TRUE(run.whole) << "a message may have gone into the output";
}

TEST(Pipes, GetTheirFilesWholeAndOnce) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(60));
  const std::string out = make_pipe(directory, "out.obj"), report = make_pipe(directory, "r.json");
  std::string mesh_text, report_text;
  std::thread mesh_reader([&] { mesh_text = directory.read("out.obj"); });
  std::thread report_reader([&] { report_text = directory.read("r.json"); });
  const Outcome outcome = run({"flatten", in, out, "--report", report});
  mesh_reader.join();
  report_reader.join();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string plain = directory.path("plain.obj");
  ASSERT_EQ(run({"flatten", in, plain}).exit_code, 0);
  EXPECT_EQ(mesh_text, directory.read("plain.obj"));
  EXPECT_EQ(nlohmann::json::parse(report_text)["status"], "BELTRAMI_OK");
  EXPECT_TRUE(std::filesystem::is_fifo(out));
}

TEST(Pipes, WhoseReaderLeavesFailTheirWrite) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(60)), out = make_pipe(directory, "out.obj");
  Program program({"flatten", in, out});
  const int reader = open(out.c_str(), O_RDONLY);  // waits for the program
  char first = 0;
  EXPECT_EQ(read(reader, &first, 1), 1);
  close(reader);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 2) << outcome.signal;
  EXPECT_EQ(outcome.err.rfind("beltrami: " + out + ": cannot be written", 0), 0u) << outcome.err;
}

}  // namespace
}  // namespace beltrami::cli
