// Signals: exit code, message, and nothing left behind. No test depends on how long a run takes:
// the program waits for a pipe while the signal comes, or the run itself raises it.
#include "process/interrupt.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "commands/command.h"
#include "files/mesh_file.h"
#include "files/surface.h"
#include "process/failure.h"
#include "process/leftovers.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

/// The program with everything written but its report, which is a pipe that nobody reads.
class Waiting {
 public:
  explicit Waiting(const Surroundings& around = {})
      : program({"flatten", directory.file("in.obj", kSquare),
                 directory.file("out.obj", "precious"), "--report", make_pipe(directory, "report")},
                around) {
    program.wait_until([&] { return has_temporary(directory); });
  }

  void expect_nothing_left() const {
    EXPECT_EQ(directory.read("out.obj"), "precious");
    EXPECT_EQ(directory.names().size(), 3u) << "a temporary is left";
  }

  TemporaryDirectory directory;
  Program program;
};

class Interrupt : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, testing::Values(SIGINT, SIGTERM, SIGHUP, SIGXCPU));

TEST_P(Interrupt, CancelsAndLeavesTheTargetAlone) {
  Waiting waiting;
  waiting.program.send(GetParam());
  const Outcome outcome = waiting.program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "cancelled\n");
  waiting.expect_nothing_left();
}

TEST_P(Interrupt, CancelsTheReadingOfAPipe) {
  const TemporaryDirectory directory;
  const std::string in = make_pipe(directory, "in.obj");
  const std::string out = directory.file("out.obj", "precious");
  Program program({"flatten", in, out, "--report", directory.path("r.json")});
  const int pipe = open(in.c_str(), O_WRONLY);  // waits for the program
  ASSERT_EQ(write(pipe, "v 0 0 0\n", 8), 8);
  program.send(GetParam());
  const Outcome outcome = program.wait();
  close(pipe);
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.err, "cancelled\n");
  EXPECT_EQ(directory.read("out.obj"), "precious");
  EXPECT_EQ(directory.names().size(), 3u) << "a temporary is left";
  EXPECT_EQ(nlohmann::json::parse(directory.read("r.json"))["status"], "BELTRAMI_E_CANCELLED");
}

/// Runs the library as the program does, with the signal at call number `at` of its progress.
/// Returns the status of the run; the number of calls through `calls`.
beltrami_status run_with_signal(int signal_number, int at, int& calls) {
  const TemporaryDirectory directory;
  const MeshFile file = read_mesh(directory.file("in.obj", grid(8)), Content::kSurface);
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = file.vertex_count();
  mesh.face_count = file.polygons.size();
  mesh.positions = {file.positions.data(), 0, BELTRAMI_F64, 0};
  mesh.indices = {file.polygons.corners().data(), 0, BELTRAMI_U32, 0};
  beltrami_context* context = nullptr;
  beltrami_create(&context);
  beltrami_set_mesh(context, &mesh);
  struct State {
    int signal_number, at, calls;
  } state{signal_number, at, 0};
  const auto progress = [](void* user, double, const char*) -> std::int32_t {
    auto& self = *static_cast<State*>(user);
    if (self.calls++ == self.at) raise(self.signal_number);
    return 0;
  };
  beltrami_status status = BELTRAMI_E_INTERNAL;
  {
    const CancelOnInterrupt guard(context);
    status = beltrami_run(context, progress, &state);
  }
  beltrami_destroy(context);
  calls = state.calls;
  return status;
}

TEST_P(Interrupt, IsHeardByARunAtAnyCallOfItsProgress) {
  int calls = 0;
  ASSERT_EQ(run_with_signal(GetParam(), -1, calls), BELTRAMI_OK);
  ASSERT_GE(calls, 3);
  for (const int at : {0, calls / 2, calls - 1}) {
    // A process of its own, since signals are counted for good.
    EXPECT_EXIT(
        {
          std::signal(GetParam(), SIG_DFL);  // whatever the parent of the tests has ignored
          install_signal_handlers();
          int heard_at = 0;
          const bool cancelled = run_with_signal(GetParam(), at, heard_at) == BELTRAMI_E_CANCELLED;
          _exit(cancelled && interrupted() && heard_at == at + 1 ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
  }
}

TEST_P(Interrupt, IsHeardByAChecksWork) {
  const TemporaryDirectory directory;
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  const MeshFile file = read_mesh(directory.file("in.obj", text), Content::kUvs);
  const Surface surface(file, false);
  const auto check = [&] {
    const beltrami_mesh mesh = view_of(surface.view());
    const beltrami_buffer uvs = uv_view(surface.view());
    beltrami_certificate certificate{};
    certificate.struct_size = sizeof certificate;
    return beltrami_check_injective(&mesh, &uvs, &certificate);
  };
  ASSERT_EQ(check(), BELTRAMI_OK);
  EXPECT_EXIT(
      {
        std::signal(GetParam(), SIG_DFL);
        install_signal_handlers();
        raise(GetParam());
        _exit(check() == BELTRAMI_E_CANCELLED ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

TEST_P(Interrupt, IsNotHeardWhereTheParentIgnoresIt) {
  Surroundings around;
  around.ignored = {GetParam()};
  Waiting waiting(around);
  for (int i = 0; i < 3; ++i) waiting.program.send(GetParam());
  const std::string report = waiting.directory.read("report");  // the pipe's reader at last
  EXPECT_EQ(waiting.program.wait().exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(report)["status"], "BELTRAMI_OK");
  EXPECT_NE(waiting.directory.read("out.obj"), "precious");
}

/// A process that does not look around, with a file that must not stay behind.
template <class Wait>
void never_look(int first, int second, const std::string& leftover, const Wait& wait) {
  for (const int number : {first, second, SIGALRM}) std::signal(number, SIG_DFL);
  install_signal_handlers();
  const Leftover file(leftover);
  raise(first);
  wait();
  raise(second);
  for (;;) pause();
}

TEST(Interrupts, TheSecondEndsAProcessThatNeverLooksAndLeavesNothing) {
  const TemporaryDirectory directory;
  for (const auto& [first, second] : {std::pair(SIGTERM, SIGTERM), std::pair(SIGINT, SIGTERM)}) {
    for (const int milliseconds : {0, 400}) {  // of the same request, and of another
      const std::string leftover = directory.file("leftover", "x");
      EXPECT_EXIT(never_look(first, second, leftover, [&] { usleep(1000 * milliseconds); }),
                  testing::ExitedWithCode(130), "");
      EXPECT_FALSE(std::filesystem::exists(leftover));
    }
  }
}

TEST(Interrupts, TwoOfOneRequestLetTheProcessEndByItself) {
  Waiting waiting;
  waiting.program.send(SIGSTOP);
  for (const int number : {SIGINT, SIGTERM}) waiting.program.send(number);
  waiting.program.send(SIGCONT);  // and both are there
  const Outcome outcome = waiting.program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.err, "cancelled\n");
  waiting.expect_nothing_left();
}

TEST(Interrupts, IsHeardByTheReadersOfText) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 1 0 0 0 1 0 3 0 1 2";
  EXPECT_EXIT(
      {
        std::signal(SIGTERM, SIG_DFL);
        install_signal_handlers();
        raise(SIGTERM);
        int cancelled = 0;
        const auto read = [&](auto reader, const std::string& text) {
          try {
            reader(text, "a", Content::kSurface);
          } catch (const Failure& failure) {
            cancelled += failure.exit_code == kExitCancelled;
          }
        };
        read(read_obj, obj);
        read(read_ply, ply);
        read(read_off, "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2");
        read(read_stl, "solid\nfacet normal 0 0 1\n");
        read(read_stl, std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(50, '\0'));
        _exit(cancelled);
      },
      testing::ExitedWithCode(5), "");
}

TEST(Interrupts, SignalsThatKillLeaveNothing) {
  for (const int number : {SIGQUIT, SIGABRT, SIGALRM, SIGUSR1, SIGUSR2, SIGVTALRM}) {
    Surroundings around;
    around.limits = {{RLIMIT_CORE, 0}};
    Waiting waiting(around);
    waiting.program.send(number);
    EXPECT_EQ(waiting.program.wait().signal, number) << "the parent learns what it was";
    waiting.expect_nothing_left();
  }
}

TEST(Interrupts, ALimitOfTheFileSizeIsAFailureOfTheWrite) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(20));
  const std::string out = directory.file("out.obj", "precious");
  Surroundings around;
  around.limits = {{RLIMIT_FSIZE, 4096}};
  const Outcome outcome = run({"flatten", in, out}, around);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err.rfind("beltrami: " + out + ": cannot be written", 0), 0u) << outcome.err;
  EXPECT_EQ(outcome.err_lines(), 1);
  EXPECT_EQ(directory.read("out.obj"), "precious");
  EXPECT_EQ(directory.names().size(), 2u) << "a temporary is left";
}

}  // namespace
}  // namespace beltrami::cli
