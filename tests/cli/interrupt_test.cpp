// Ctrl-C: exit code, message, and nothing left behind.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "run_program.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

class Interrupt : public testing::TestWithParam<int> {};

TEST_P(Interrupt, CancelsAndLeavesTheTargetAlone) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(150));
  const std::string out = directory.file("out.obj", "precious");
  // Iterations without end, so that the signal cannot come too late. Too early would kill a process
  // that has not yet set its handler: a busy machine gets another chance.
  Outcome outcome;
  for (int patience = 700; patience < 10000 && outcome.exit_code == -1; patience *= 3) {
    Program program({"flatten", in, out, "--method", "cm", "--tolerance", "0", "--max-iterations",
                     "1000000", "--report", directory.path("r.json")});
    std::this_thread::sleep_for(std::chrono::milliseconds(patience));
    kill(program.id(), GetParam());
    outcome = program.wait();
  }
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "cancelled\n");
  EXPECT_EQ(directory.read("out.obj"), "precious");
  EXPECT_EQ(directory.names().size(), 3u) << "a temporary is left";
  EXPECT_EQ(nlohmann::json::parse(directory.read("r.json"))["status"], "BELTRAMI_E_CANCELLED");
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace beltrami::cli
