// The threads of a host in place of those of the library: the same bits on any of them.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "abi/host.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::host {
namespace {

using meshes::TriangleList;

/// A job system of its own kind, and what it saw.
struct Jobs {
  enum class Way { kSideBySide, kOneByOne, kBackwards, kNone, kOnlyOne };
  Way way = Way::kSideBySide;
  int loops = 0;
  std::int32_t most = 0;        // jobs of a loop
  std::atomic<int> inside = 0;  // loops: one at a time
  std::thread::id caller = std::this_thread::get_id();

  static void run(void* user, std::int32_t count, beltrami_job job, void* data) {
    auto& self = *static_cast<Jobs*>(user);
    EXPECT_EQ(std::this_thread::get_id(), self.caller);
    EXPECT_EQ(self.inside++, 0);
    ++self.loops;
    self.most = std::max(self.most, count);
    self.call(count, job, data);
    --self.inside;
  }

 private:
  void call(std::int32_t count, beltrami_job job, void* data) const {
    switch (way) {
      case Way::kSideBySide: {
        std::vector<std::jthread> threads;
        for (std::int32_t i = 0; i < count; ++i) threads.emplace_back([=] { job(data, i); });
        break;
      }
      case Way::kOneByOne:
        for (std::int32_t i = 0; i < count; ++i) job(data, i);
        break;
      case Way::kBackwards:
        for (std::int32_t i = count; i-- > 0;) std::jthread([=] { job(data, i); });
        break;
      case Way::kNone:
        break;
      case Way::kOnlyOne:
        job(data, count - 1);
        break;
    }
  }
};

std::vector<std::array<double, 2>> flattened(const TriangleList& mesh, std::uint64_t threads,
                                             Jobs* jobs) {
  const Context context = whole_pipeline(mesh);
  set_option(context, BELTRAMI_OPTION_THREADS, threads);
  if (jobs != nullptr) {
    EXPECT_EQ(beltrami_set_parallel_for(context.get(), &Jobs::run, jobs), BELTRAMI_OK);
  }
  EXPECT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
  return uvs(context, mesh.positions.size());
}

std::vector<double> unwrapped(const TriangleList& mesh, std::uint64_t threads, Jobs* jobs) {
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_THREADS, threads);
  if (jobs != nullptr) {
    EXPECT_EQ(beltrami_set_parallel_for(context.get(), &Jobs::run, jobs), BELTRAMI_OK);
  }
  const beltrami_surface surface = surface_view(mesh);
  EXPECT_EQ(beltrami_unwrap(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK)
      << message(context);
  std::vector<double> corner_uvs(6 * mesh.faces.size());
  EXPECT_EQ(beltrami_get_corner_uvs(context.get(), corner_uvs.data(), BELTRAMI_F64, 0),
            BELTRAMI_OK);
  return corner_uvs;
}

TEST(HostThreads, GiveTheSameBitsAtOneTwoAndSeven) {
  const TriangleList disk = meshes::bumps(40, 40);
  const TriangleList closed = meshes::torus(25);
  const auto map = flattened(disk, 1, nullptr);
  const auto atlas = unwrapped(closed, 1, nullptr);
  for (const std::uint64_t threads : {1, 2, 7}) {
    Jobs jobs;
    EXPECT_TRUE(same_bits(flattened(disk, threads, &jobs), map)) << threads;
    EXPECT_TRUE(same_bits(unwrapped(closed, threads, &jobs), atlas)) << threads;
    EXPECT_EQ(jobs.loops > 0, threads > 1);
    EXPECT_LE(jobs.most, static_cast<std::int32_t>(threads));
  }
}

TEST(HostThreads, AreThoseOfSessionsToo) {
  const TriangleList mesh = meshes::bumps(60, 60);
  const Context context = create();
  set_option(context, BELTRAMI_OPTION_THREADS, 3);
  Jobs jobs;
  ASSERT_EQ(beltrami_set_parallel_for(context.get(), &Jobs::run, &jobs), BELTRAMI_OK);
  const beltrami_surface surface = surface_view(mesh);
  ASSERT_EQ(beltrami_session_begin(context.get(), &surface, nullptr, nullptr), BELTRAMI_OK);
  const int begun = jobs.loops;
  EXPECT_GT(begun, 0);
  ASSERT_EQ(beltrami_session_update(context.get(), 0, 0, nullptr, nullptr), BELTRAMI_OK);
  EXPECT_GT(jobs.loops, begun);
}

TEST(HostThreads, MayRunJobsInAnyOrderAndOnAnyThread) {
  const TriangleList disk = meshes::bumps(30, 30);
  const auto map = flattened(disk, 1, nullptr);
  for (const Jobs::Way way : {Jobs::Way::kOneByOne, Jobs::Way::kBackwards}) {
    Jobs jobs{.way = way};
    EXPECT_TRUE(same_bits(flattened(disk, 3, &jobs), map));
    EXPECT_GT(jobs.loops, 0);
  }
}

// A loop that leaves jobs out is a defect of the host; the thread of the call does what is left.
TEST(HostThreads, NothingIsLeftUndoneWhereJobsAreLeftOut) {
  const TriangleList disk = meshes::bumps(30, 30);
  const auto map = flattened(disk, 1, nullptr);
  for (const Jobs::Way way : {Jobs::Way::kNone, Jobs::Way::kOnlyOne}) {
    Jobs jobs{.way = way};
    EXPECT_TRUE(same_bits(flattened(disk, 3, &jobs), map));
  }
}

TEST(HostThreads, ARunIsCancelledFromAJob) {
  const TriangleList disk = meshes::bumps(40, 40);
  const Context context = whole_pipeline(disk);
  struct Cancelling {
    beltrami_context* context;
    static void run(void* user, std::int32_t count, beltrami_job job, void* data) {
      beltrami_cancel(static_cast<Cancelling*>(user)->context);
      for (std::int32_t i = 0; i < count; ++i) std::jthread([=] { job(data, i); });
    }
  } cancelling{context.get()};
  ASSERT_EQ(beltrami_set_parallel_for(context.get(), &Cancelling::run, &cancelling), BELTRAMI_OK);
  EXPECT_EQ(run(context), BELTRAMI_E_CANCELLED);
}

TEST(HostThreads, AreTakenBackByNull) {
  const TriangleList disk = meshes::bumps(30, 30);
  Jobs jobs;
  const Context context = whole_pipeline(disk);
  ASSERT_EQ(beltrami_set_parallel_for(context.get(), &Jobs::run, &jobs), BELTRAMI_OK);
  ASSERT_EQ(beltrami_set_parallel_for(context.get(), nullptr, nullptr), BELTRAMI_OK);
  EXPECT_EQ(run(context), BELTRAMI_OK);
  EXPECT_EQ(jobs.loops, 0);
  EXPECT_EQ(beltrami_set_parallel_for(nullptr, &Jobs::run, &jobs), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(HostThreads, CannotBeLentDuringARun) {
  const TriangleList disk = meshes::bumps(10, 10);
  const Context context = loaded(disk);
  const auto meddle = [](void* user, double, const char*) -> std::int32_t {
    EXPECT_EQ(beltrami_set_parallel_for(static_cast<beltrami_context*>(user), &Jobs::run, nullptr),
              BELTRAMI_E_INVALID_STATE);
    return 0;
  };
  EXPECT_EQ(beltrami_run(context.get(), meddle, context.get()), BELTRAMI_OK);
}

}  // namespace
}  // namespace beltrami::host
