// The memory of a run: estimated before it, limited, and measured.
#include <utility>
#include <vector>

#include "abi/host.h"

#ifdef __linux__
#include <malloc.h>

#include <fstream>
#endif

namespace beltrami {
namespace {

using namespace host;

std::uint64_t estimate(const Context& context) {
  std::uint64_t bytes = 0;
  EXPECT_EQ(beltrami_estimate_memory(context.get(), &bytes), BELTRAMI_OK) << message(context);
  return bytes;
}

void set(const Context& context, std::int32_t key, std::uint64_t value) {
  ASSERT_EQ(beltrami_set_int(context.get(), key, static_cast<std::int64_t>(value)), BELTRAMI_OK)
      << message(context);
}

TEST(Memory, NeedsAContextAMeshAndAPlaceForTheAnswer) {
  std::uint64_t bytes = 7;
  EXPECT_EQ(beltrami_estimate_memory(nullptr, &bytes), BELTRAMI_E_INVALID_ARGUMENT);
  const Context context = create();
  EXPECT_EQ(beltrami_estimate_memory(context.get(), &bytes), BELTRAMI_E_INVALID_STATE);
  EXPECT_NE(message(context).find("mesh"), std::string::npos) << message(context);
  EXPECT_EQ(bytes, 7u) << "written without an answer";
  ASSERT_EQ(set_mesh(context, meshes::bumps(4, 4)), BELTRAMI_OK);
  EXPECT_EQ(beltrami_estimate_memory(context.get(), nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context), "");
  EXPECT_GT(estimate(context), 0u);
}

TEST(Memory, IsNotAskedForDuringARun) {
  const Context context = loaded(meshes::bumps(4, 4));
  const auto ask = [](void* user, double, const char*) -> std::int32_t {
    std::uint64_t bytes = 0;
    auto* self = static_cast<beltrami_context*>(user);
    return beltrami_estimate_memory(self, &bytes) == BELTRAMI_E_INVALID_STATE ? 0 : 1;
  };
  EXPECT_EQ(beltrami_run(context.get(), ask, context.get()), BELTRAMI_OK) << message(context);
}

TEST(Memory, GrowsWithTheMeshInEveryMode) {
  const Context context = create();
  std::vector<std::uint64_t> least, before;
  for (const Index side : {8, 80, 160, 240, 400}) {
    ASSERT_EQ(set_mesh(context, meshes::bumps(side, side)), BELTRAMI_OK);
    std::vector<std::uint64_t> now;
    const auto ask_all = [&](std::int32_t key) {
      for (std::int32_t value = 0; beltrami_option_choice(key, value) != nullptr; ++value) {
        set(context, key, static_cast<std::uint64_t>(value));
        now.push_back(estimate(context));
      }
      set(context, key, 0);
    };
    ask_all(BELTRAMI_OPTION_METHOD);
    ask_all(BELTRAMI_OPTION_FLATTEN);
    ask_all(BELTRAMI_OPTION_DELAUNAY);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_GE(now[i], before[i]) << "mode " << i;
    if (least.empty()) least = now;
    before = now;
  }
  for (std::size_t i = 0; i < least.size(); ++i) EXPECT_GT(before[i], least[i]) << "mode " << i;
}

TEST(Memory, GrowsWithWhatIsAskedFor) {
  const Context context = create();
  ASSERT_EQ(set_mesh(context, meshes::bumps(160, 160)), BELTRAMI_OK);
  set(context, BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET);
  const std::uint64_t plain = estimate(context);
  set(context, BELTRAMI_OPTION_THREADS, 8);
  const std::uint64_t threaded = estimate(context);
  EXPECT_GT(threaded, plain);
  set(context, BELTRAMI_OPTION_REFINE, 1);
  EXPECT_GT(estimate(context), threaded);
}

TEST(Memory, ALimitBelowTheEstimateEndsTheRunBeforeItStarts) {
  const Context context = loaded(meshes::bumps(16, 16));
  const std::uint64_t needed = estimate(context);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto first = uvs(context, 17 * 17);

  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, needed - 1);
  EXPECT_EQ(estimate(context), needed);
  bool started = false;
  const auto note = [](void* user, double, const char*) -> std::int32_t {
    *static_cast<bool*>(user) = true;
    return 0;
  };
  EXPECT_EQ(beltrami_run(context.get(), note, &started), BELTRAMI_E_OUT_OF_MEMORY);
  EXPECT_FALSE(started);
  for (const char* word : {"MiB", "memory-limit", "fewer faces"}) {
    EXPECT_NE(message(context).find(word), std::string::npos) << message(context);
  }
  EXPECT_TRUE(same_bits(uvs(context, 17 * 17), first)) << "the old results are gone";

  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, needed);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, 1);
  EXPECT_EQ(run(context), BELTRAMI_E_OUT_OF_MEMORY);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, 0);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  EXPECT_TRUE(same_bits(uvs(context, 17 * 17), first));
}

TEST(Memory, ALimitLeavesOutWhatFewMeshesNeedFirst) {
  const Context context = create();
  ASSERT_EQ(set_mesh(context, meshes::bumps(160, 160)), BELTRAMI_OK);
  const std::uint64_t all = estimate(context);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, all);
  EXPECT_EQ(estimate(context), all);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, all - 1);
  const std::uint64_t less = estimate(context);
  EXPECT_LT(less, all);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, 1);
  const std::uint64_t least = estimate(context);
  EXPECT_LE(least, less);
  EXPECT_LT(3 * least, 2 * all) << "Newton steps are said to take most";
}

#ifdef __linux__
double memory_of_process(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

/// What the process grows by from `before` to its peak from here on.
class PeakFrom {
 public:
  explicit PeakFrom(double before) : before_(before) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;  // the kernel's mark of the peak starts anew
  }
  double bytes() const { return memory_of_process("VmHWM") - before_; }

 private:
  double before_;
};

using Setting = std::pair<std::int32_t, int>;  // key and value of an option

class MemoryOfMode : public testing::TestWithParam<std::vector<Setting>> {};

// CTest runs each in a process of its own, whose peak is therefore theirs.
TEST_P(MemoryOfMode, TakesNoMoreThanEstimated) {
  const meshes::TriangleList mesh = meshes::bumps(230, 230);
  malloc_trim(0);
  const double before = memory_of_process("VmRSS");
  const Context context = create();
  for (const auto& [key, value] : GetParam()) set(context, key, static_cast<std::uint64_t>(value));
  ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  const auto estimated = static_cast<double>(estimate(context));
  const PeakFrom peak(before);
  ASSERT_GE(run(context), BELTRAMI_OK) << message(context);
  EXPECT_LE(peak.bytes(), estimated);
  EXPECT_GE(peak.bytes(), 0.3 * estimated) << "the estimate says nothing";
}

INSTANTIATE_TEST_SUITE_P(
    Modes, MemoryOfMode,
    testing::Values(std::vector<Setting>{{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET},
                                         {BELTRAMI_OPTION_THREADS, 2}},
                    std::vector<Setting>{{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_GIF}},
                    std::vector<Setting>{{BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_CM},
                                         {BELTRAMI_OPTION_MAX_ITERATIONS, 1}}));

// With a limit that all but the steps of few meshes fit into.
TEST(MemoryOfLimitedRun, StaysWithinItsLimit) {
  const meshes::TriangleList mesh = meshes::bumps(230, 230);
  malloc_trim(0);
  const double before = memory_of_process("VmRSS");
  const Context context = create();
  ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, 1);
  const std::uint64_t limit = estimate(context);
  set(context, BELTRAMI_OPTION_MEMORY_LIMIT, limit);
  const PeakFrom peak(before);
  ASSERT_GE(run(context), BELTRAMI_OK) << message(context);
  EXPECT_LE(peak.bytes(), static_cast<double>(limit));
  EXPECT_GE(peak.bytes(), 0.5 * static_cast<double>(limit)) << "the estimate says nothing";
}

#endif

}  // namespace
}  // namespace beltrami
