// The memory of a run: estimated before it, and limited.
#include <string>
#include <vector>

#include "abi/host.h"
#include "base/types.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;

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
  for (const Index side : {8, 80, 160, 240, 400, 440, 460, 640}) {
    ASSERT_EQ(set_mesh(context, meshes::bumps(side, side)), BELTRAMI_OK);
    std::vector<std::uint64_t> now;
    const auto ask_all = [&](std::int32_t key) {
      for (std::int32_t value = 0; beltrami_option_choice(key, value) != nullptr; ++value) {
        set_option(context, key, static_cast<std::uint64_t>(value));
        now.push_back(estimate(context));
      }
      set_option(context, key, 0);
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
  set_option(context, BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET);
  const std::uint64_t plain = estimate(context);
  set_option(context, BELTRAMI_OPTION_THREADS, 8);
  const std::uint64_t threaded = estimate(context);
  EXPECT_GT(threaded, plain);
  set_option(context, BELTRAMI_OPTION_REFINE, 1);
  EXPECT_GT(estimate(context), threaded);
}

TEST(Memory, ALimitBelowTheEstimateEndsTheRunBeforeItStarts) {
  const Context context = loaded(meshes::bumps(16, 16));
  const std::uint64_t needed = estimate(context);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto first = uvs(context, 17 * 17);

  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, needed - 1);
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

  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, needed);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, 1);
  EXPECT_EQ(run(context), BELTRAMI_E_OUT_OF_MEMORY);
  set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, 0);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  EXPECT_TRUE(same_bits(uvs(context, 17 * 17), first));
}

TEST(Memory, TheEstimateDoesNotDependOnTheLimit) {
  const Context context = create();
  ASSERT_EQ(set_mesh(context, meshes::bumps(160, 160)), BELTRAMI_OK);
  const std::uint64_t unlimited = estimate(context);
  for (const double limit : {1.0, 1e8, 1e13}) {
    set_option(context, BELTRAMI_OPTION_MEMORY_LIMIT, static_cast<std::int64_t>(limit));
    EXPECT_EQ(estimate(context), unlimited);
  }
}

}  // namespace
}  // namespace beltrami
