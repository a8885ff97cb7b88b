#include "base/work.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/loop_trace.h"
#include "base/parallel.h"

namespace {

using beltrami::Work;

TEST(Work, PartsFillTheirShareAndProgressNeverFalls) {
  std::vector<std::pair<double, std::string>> seen;
  const Work whole({}, [&](double fraction, const char* stage) {
    seen.emplace_back(fraction, stage);
    return false;
  });
  const Work second = whole.part(0.5, 1).named("second");
  whole.part(0, 0.5).named("first").report(1);
  second.part(0.5, 1).report(0.5);
  second.report(0);
  const std::vector<std::pair<double, std::string>> expected = {
      {0.5, "first"}, {0.875, "second"}, {0.875, "second"}};
  EXPECT_EQ(seen, expected);
}

TEST(Work, EndsWhereProgressSaysSo) {
  const Work work({}, [](double fraction, const char*) { return fraction > 0.5; });
  work.report(0.5);
  EXPECT_THROW(work.report(0.75), beltrami::Cancelled);
}

TEST(Work, AsideKeepsToItsThreadAndSaysNothing) {
  int calls = 0;
  const Work work({.threads = 4}, [&](double, const char*) { return ++calls > 0; });
  const Work aside = work.part(0, 0.5).aside();
  EXPECT_EQ(work.threads(), 4);
  EXPECT_EQ(aside.threads(), 1);
  EXPECT_NO_THROW(aside.report(1));
  EXPECT_EQ(calls, 0);
  const std::atomic<bool> cancelled{true};
  const beltrami::InterruptScope scope(&cancelled);
  EXPECT_THROW(aside.report(1), beltrami::Cancelled);
}

TEST(Work, TimeRunsOutForAllSharesAlike) {
  const Work endless;
  EXPECT_FALSE(endless.part(0.5, 1).out_of_time());
  const Work short_of_it({.seconds = 1e-9}, nullptr);
  while (!short_of_it.out_of_time()) {
  }
  EXPECT_TRUE(short_of_it.part(0.5, 1).out_of_time());
}

TEST(Work, ATraceTellsTheChunksOfLoopsButNotOfThoseWithin) {
  std::vector<std::size_t> loops;
  beltrami::LoopTrace trace([&](const std::string& stage, const std::vector<double>& chunks) {
    loops.push_back(chunks.size());
    EXPECT_EQ(stage, loops.size() == 1 ? "first" : "");
    for (const double seconds : chunks) EXPECT_GE(seconds, 0);
  });
  const Work work({.threads = 16, .trace = &trace}, nullptr);
  int calls = 0;  // no thread but this one
  const char* before = trace.enter("first");
  beltrami::parallel_for(work, 10, 4, [&](std::int64_t begin, std::int64_t end) {
    beltrami::parallel_for(work, end - begin, 1, [&](std::int64_t, std::int64_t) { ++calls; });
  });
  trace.enter(before);
  const auto fail = [](std::int64_t, std::int64_t) { throw std::runtime_error("a chunk"); };
  EXPECT_THROW(beltrami::parallel_for(work, 3, 1, fail), std::runtime_error);
  beltrami::parallel_for(work, 2, 1, [&](std::int64_t, std::int64_t) { ++calls; });
  beltrami::parallel_for(work.aside(), 2, 1, [&](std::int64_t, std::int64_t) { ++calls; });
  const std::vector<std::size_t> expected = {3, 2};
  EXPECT_EQ(loops, expected);
  EXPECT_EQ(calls, 14);
}

}  // namespace
