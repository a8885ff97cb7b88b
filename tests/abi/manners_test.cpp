// What a library may not do to the process of its host: print, leave threads, files, signals,
// locales or environment changed.
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <new>
#include <set>
#include <thread>

#include "abi/host.h"
#include "support/meshes.h"

extern "C" char** environ;

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

/// Of the list of threads, a millisecond apart: a thread that has ended leaves it within a few.
constexpr int kMostPolls = 10'000;

/// Uses all of the library: every method, workers, results, checks, and failures of each kind.
void use_everything() {
  const TriangleList mesh = meshes::bumps(24, 20);
  for (int32_t method = 0; beltrami_option_choice(BELTRAMI_OPTION_METHOD, method); ++method) {
    const Context context = loaded(mesh);
    EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, method), BELTRAMI_OK);
    EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_COARSE_FACES, 200), BELTRAMI_OK);
    EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 3), BELTRAMI_OK);
    EXPECT_GE(run(context), BELTRAMI_OK) << message(context);
    const auto found = uvs(context, mesh.positions.size());
    const beltrami_mesh mesh_view = view(mesh);
    const beltrami_buffer uv_view = view(found);
    auto certificate = sized<beltrami_certificate>();
    auto energy = sized<beltrami_energy>();
    EXPECT_GE(beltrami_check_injective(&mesh_view, &uv_view, &certificate), BELTRAMI_OK);
    EXPECT_GE(beltrami_measure(&mesh_view, &uv_view, &energy, nullptr), BELTRAMI_OK);
    beltrami_cancel(context.get());
    EXPECT_EQ(run(context), BELTRAMI_E_CANCELLED);
  }
  const Context context = create();
  EXPECT_LT(run(context), BELTRAMI_OK);
  EXPECT_LT(set_mesh(context, meshes::octahedron()), BELTRAMI_OK);
  EXPECT_LT(set_mesh(context, meshes::bowtie()), BELTRAMI_OK);
  EXPECT_LT(beltrami_set_int(context.get(), 999, 1), BELTRAMI_OK);
  EXPECT_LT(beltrami_set_float(context.get(), BELTRAMI_OPTION_TOLERANCE, 7), BELTRAMI_OK);
  EXPECT_LT(beltrami_create_(BELTRAMI_ABI + 1, nullptr), BELTRAMI_OK);
  beltrami_context* refused = nullptr;
  EXPECT_LT(beltrami_create_(BELTRAMI_ABI + 1, &refused), BELTRAMI_OK);
}

/// Sends a file descriptor into a file for as long as it lives.
class Captured {
 public:
  explicit Captured(int descriptor) : descriptor_(descriptor), saved_(dup(descriptor)) {
    dup2(fileno(file_), descriptor_);
  }
  ~Captured() {
    dup2(saved_, descriptor_);
    close(saved_);
    std::fclose(file_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  off_t bytes() const {
    std::fflush(nullptr);
    struct stat status {};
    fstat(fileno(file_), &status);
    return status.st_size;
  }

 private:
  int descriptor_;
  int saved_;
  std::FILE* file_ = std::tmpfile();
};

TEST(Manners, NothingIsPrinted) {
  std::fflush(nullptr);
  const Captured out(STDOUT_FILENO), error(STDERR_FILENO);
  use_everything();
  EXPECT_EQ(out.bytes(), 0);
  EXPECT_EQ(error.bytes(), 0);
}

std::set<std::string> entries(const char* folder) {
  std::set<std::string> names;
  DIR* open = opendir(folder);
  while (const dirent* entry = readdir(open)) names.insert(entry->d_name);
  closedir(open);
  return names;
}

/// What belongs to the process as a whole.
struct ProcessState {
  std::map<std::string, std::string> texts;

  ProcessState() {
    for (char** variable = environ; *variable; ++variable) texts["environment"] += *variable;
    texts["locale"] = std::setlocale(LC_ALL, nullptr);
    std::array<char, 4096> path{};
    texts["folder"] = getcwd(path.data(), path.size());
    const mode_t mask = umask(0);
    umask(mask);
    texts["umask"] = std::to_string(mask);
    for (int number = 1; number < NSIG; ++number) {
      struct sigaction action {};
      if (sigaction(number, nullptr, &action) != 0) continue;
      add("signals", reinterpret_cast<uintptr_t>(action.sa_handler));
      add("signals", static_cast<uintptr_t>(action.sa_flags));
    }
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    for (int number = 1; number < NSIG; ++number)
      add("mask", static_cast<uintptr_t>(sigismember(&blocked, number)));
    for (const std::string& name : entries("/proc/self/fd")) texts["files"] += name + " ";
    texts["threads"] = std::to_string(entries("/proc/self/task").size());
    add("terminate", reinterpret_cast<uintptr_t>(std::get_terminate()));
    add("new", reinterpret_cast<uintptr_t>(std::get_new_handler()));
  }

 private:
  void add(const char* what, uintptr_t value) { texts[what] += std::to_string(value) + " "; }
};

TEST(Manners, TheProcessIsLeftAsItWas) {
  setenv("OMP_NUM_THREADS", "3", 1);
  std::thread([] {}).join();  // with the first one the thread sanitizer starts one of its own
  const ProcessState before;
  use_everything();
  // Ended threads leave the list a little after they were joined.
  for (int polls = 0; polls < kMostPolls; ++polls) {
    if (ProcessState().texts["threads"] == before.texts.at("threads")) break;
    usleep(1000);
  }
  EXPECT_EQ(ProcessState().texts, before.texts);
}

TEST(Manners, RandomNumbersOfTheHostGoOn) {
  srand(5);
  const int first = rand(), second = rand();
  srand(5);
  EXPECT_EQ(rand(), first);
  use_everything();
  EXPECT_EQ(rand(), second);
}

TEST(Manners, ALocaleWithADecimalCommaChangesNothing) {
  const TriangleList mesh = meshes::bumps(9, 8);
  const Context context = loaded(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto expected = uvs(context, mesh.positions.size());
  EXPECT_LT(beltrami_set_float(context.get(), BELTRAMI_OPTION_TOLERANCE, 2.5), BELTRAMI_OK);
  const std::string expected_message = message(context);
  EXPECT_NE(expected_message.find("2.5"), std::string::npos) << expected_message;
  bool found = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "fr_FR"}) {
    found = found || std::setlocale(LC_ALL, name) != nullptr;
  }
  if (!found) GTEST_SKIP() << "no such locale is installed; the gate on imports still holds";
  ASSERT_EQ(run(context), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(uvs(context, mesh.positions.size()), expected));
  beltrami_set_float(context.get(), BELTRAMI_OPTION_TOLERANCE, 2.5);
  EXPECT_EQ(message(context), expected_message);
  std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace beltrami
