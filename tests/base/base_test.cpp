// Parallel loops and sorts, and the floating-point mode that exactness needs.
#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/bucket_sort.h"
#include "base/floating_point.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/resources.h"
#include "base/types.h"
#include "base/work.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace beltrami {
namespace {

TEST(ParallelFor, CoversEveryIndexOnceAtAnyThreadCount) {
  for (const int threads : {1, 2, 3, 8}) {
    for (const int count : {0, 1, 9, 10, 11, 1000}) {
      std::vector<int> visits(static_cast<std::size_t>(count), 0);
      parallel_for(Work(threads), count, 10, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
      });
      EXPECT_EQ(visits, std::vector<int>(visits.size(), 1)) << threads << ' ' << count;
    }
  }
}

TEST(ParallelFor, CutsTheSameChunksAtAnyThreadCount) {
  for (const int threads : {1, 2, 3}) {
    std::atomic<int> odd_chunks{0};
    parallel_for(Work(threads), 105, 10, [&](std::int64_t begin, std::int64_t end) {
      if (begin % 10 != 0 || end - begin != (begin == 100 ? 5 : 10)) ++odd_chunks;
    });
    EXPECT_EQ(odd_chunks, 0) << threads;
  }
}

TEST(ParallelFor, UsesNoMoreThreadsThanAsked) {
  std::atomic<int> inside{0}, most{0};
  parallel_for(Work(2), 64, 1, [&](std::int64_t, std::int64_t) {
    const int now = ++inside;
    for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
    }
    std::this_thread::yield();
    --inside;
  });
  EXPECT_LE(most, 2);
}

TEST(ParallelFor, RethrowsAnExceptionOfAnyThread) {
  for (const int threads : {1, 2, 3}) {
    const auto loop = [&] {
      parallel_for(Work(threads), 100, 1, [](std::int64_t begin, std::int64_t) {
        if (begin == 50) throw std::out_of_range("fifty");
      });
    };
    EXPECT_THROW(loop(), std::out_of_range) << threads;
  }
}

// The other thread is kept waiting until the exception is on its way. Without a stop it would be
// busy with the remaining chunks for years.
TEST(ParallelFor, StopsAfterAnException) {
  std::atomic<bool> thrown{false};
  const auto body = [&](std::int64_t begin, std::int64_t) {
    if (begin == 0) {
      thrown = true;
      throw std::runtime_error("at once");
    }
    while (!thrown) std::this_thread::yield();
  };
  EXPECT_THROW(parallel_for(Work(2), std::int64_t{1} << 60, 1, body), std::runtime_error);
}

TEST(ParallelFor, EndsWhereTheRunOfItsThreadIsCancelled) {
  std::atomic<bool> cancelled{false};
  const auto count_chunks = [&](int threads, std::int64_t most) {
    std::atomic<int> chunks{0};
    parallel_for(Work(threads), most, 1, [&](std::int64_t, std::int64_t) {
      if (++chunks == 10) cancelled = true;
      std::this_thread::yield();
    });
    return chunks.load();
  };
  EXPECT_EQ(count_chunks(1, 100), 100) << "outside a run nobody asks";
  for (const int threads : {1, 3}) {
    cancelled = false;
    const InterruptScope scope(&cancelled);
    EXPECT_THROW(count_chunks(threads, std::int64_t{1} << 50), Cancelled) << threads << " threads";
  }
  cancelled = false;
  const InterruptScope outer(&cancelled);
  std::atomic<bool> always{true};
  {
    const InterruptScope inner(&always);
    EXPECT_THROW(poll_interrupt(), Cancelled);
  }
  EXPECT_NO_THROW(poll_interrupt());
}

TEST(ParallelFor, StartsNoMoreThreadsForASecondLoop) {
  const Work work(3);
  std::mutex guard;
  std::set<std::thread::id> seen;
  for (int loop = 0; loop < 50; ++loop) {
    std::atomic<int> inside{0};
    parallel_for(work, 3, 1, [&](std::int64_t, std::int64_t) {
      ++inside;
      while (inside < 3) std::this_thread::yield();  // until each thread has its chunk
      const std::lock_guard lock(guard);
      seen.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen.count(std::this_thread::get_id()), 1u);
}

TEST(ParallelFor, RunsALoopInItsBodyOnTheThreadOfTheBody) {
  const Work work(3);
  std::atomic<int> inner{0}, elsewhere{0};
  parallel_for(work, 20, 1, [&](std::int64_t, std::int64_t) {
    const std::thread::id thread = std::this_thread::get_id();
    parallel_for(work, 20, 1, [&](std::int64_t, std::int64_t) {
      ++inner;
      elsewhere += std::this_thread::get_id() != thread;
    });
  });
  EXPECT_EQ(inner, 400);
  EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelFor, GoesOnAfterAnExceptionAndACancelledLoop) {
  const Work work(2);
  const auto sum = [&] {
    return parallel_sum(work, 100, 1, [](std::int64_t i, std::int64_t) { return double(i); });
  };
  for (int i = 0; i < 10; ++i) {
    EXPECT_THROW(parallel_for(work, 100, 1,
                              [](std::int64_t, std::int64_t) { throw std::out_of_range("all"); }),
                 std::out_of_range);
    EXPECT_EQ(sum(), 4950);
    const std::atomic<bool> cancelled{true};
    {
      const InterruptScope scope(&cancelled);
      EXPECT_THROW(sum(), Cancelled);
    }
    EXPECT_EQ(sum(), 4950);
  }
}

TEST(ParallelSum, HasTheSameBitsAtOneTwoAndThreeThreads) {
  const auto term = [](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i)) * 1e3;
    return sum;
  };
  const double one = parallel_sum(Work(1), 10007, 64, term);
  EXPECT_EQ(one, parallel_sum(Work(2), 10007, 64, term));
  EXPECT_EQ(one, parallel_sum(Work(3), 10007, 64, term));
}

TEST(ParallelSum, OfNothingIsZero) {
  EXPECT_EQ(parallel_sum(Work(2), 0, 64, [](std::int64_t, std::int64_t) { return 1.0; }), 0);
}

TEST(ParallelFind, FindsTheFirstAtAnyThreadCount) {
  for (const int threads : {1, 2, 5}) {
    const auto from = [&](std::int64_t first) {
      return parallel_find(Work(threads), 1000, 7,
                           [=](std::int64_t i) { return i >= first && i % 3 == 0; });
    };
    EXPECT_EQ(from(0), 0);
    EXPECT_EQ(from(500), 501);
    EXPECT_EQ(from(1000), 1000);  // none
  }
  EXPECT_EQ(parallel_find(Work(2), 0, 7, [](std::int64_t) { return true; }), 0);
}

TEST(ParallelFilter, KeepsTheOrderAtAnyThreadCount) {
  for (const int threads : {1, 2, 5}) {
    const std::vector<Index> found =
        parallel_filter(Work(threads), 100, 7, [](Index i) { return i % 40 == 39 || i == 40; });
    EXPECT_EQ(found, (std::vector<Index>{39, 40, 79}));
  }
}

TEST(ParallelAssign, GivesWhatAssignGives) {
  std::vector<std::int64_t> items;
  for (const std::size_t count : {std::size_t{3}, std::size_t{700'000}, std::size_t{500'000}}) {
    parallel_assign(Work(2), items, count, std::int64_t{7});
    EXPECT_EQ(items, std::vector<std::int64_t>(count, 7));
  }
  parallel_assign(Work(2), items, 0);
  EXPECT_TRUE(items.empty());
}

TEST(BucketSort, IsStableAtAnyThreadCount) {
  constexpr std::int64_t kItems = 300'000, kBuckets = 40'000;
  // None to three entries an item; the last bucket stays empty.
  const auto for_each_bucket = [](std::int64_t item, const auto& visit) {
    for (std::int64_t k = 0; k < item % 4; ++k) visit((item * 7919 + k * 104'729) % (kBuckets - 1));
  };
  std::vector<std::vector<std::int64_t>> expected(kBuckets);
  for (std::int64_t i = 0; i < kItems; ++i) {
    for_each_bucket(i, [&](std::int64_t bucket) { expected[bucket].push_back(i); });
  }
  for (const int threads : {1, 2, 3, 64}) {
    std::vector<Index> start;
    BucketSort<Index> sort(Work(threads), kItems, kBuckets, start, for_each_bucket);
    std::vector<std::int64_t> sorted(start.back());
    sort.place([&](std::int64_t item, const auto& place) {
      for_each_bucket(item, [&](std::int64_t bucket) { sorted[place(bucket)] = item; });
    });
    ASSERT_EQ(start.size(), expected.size() + 1);
    for (std::size_t b = 0; b < expected.size(); ++b) {
      const std::vector<std::int64_t> bucket(sorted.begin() + start[b],
                                             sorted.begin() + start[b + 1]);
      ASSERT_EQ(bucket, expected[b]) << threads << " threads, bucket " << b;
    }
  }
}

TEST(BucketSort, OfNothingHasEmptyBuckets) {
  std::vector<Index> start = {1};
  const BucketSort<Index> sort(Work(2), 0, 3, start, [](std::int64_t, const auto&) {});
  EXPECT_EQ(start, (std::vector<Index>{0, 0, 0, 0}));
}

bool keeps_subnormals() {
  volatile double least_normal = std::numeric_limits<double>::min();
  volatile double half = least_normal / 2;
  return half > 0 && half * 2 == least_normal;
}

double third() {
  volatile double one = 1, three = 3;
  return one / three;
}

// What a mode does is asked of the processor: emulated ones may not follow it, nor keep its bits.
TEST(StandardFloatingPoint, RoundsToNearestAndRestoresTheRoundingModeOfTheHost) {
  const double nearest = third();
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  const double upward = third();
  {
    const StandardFloatingPoint standard;
    EXPECT_EQ(std::fegetround(), FE_TONEAREST);
    EXPECT_EQ(third(), nearest);
  }
  EXPECT_EQ(std::fegetround(), FE_UPWARD);
  EXPECT_EQ(third(), upward);
  std::fesetround(FE_TONEAREST);
}

#if defined(__SSE2__)
constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;

TEST(StandardFloatingPoint, KeepsSubnormalsAndRestoresFlushToZeroOfTheHost) {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlushToZero | kDenormalsAreZero);
  const unsigned fast = _mm_getcsr();
  {
    const StandardFloatingPoint standard;
    EXPECT_TRUE(keeps_subnormals());
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after, fast);
}

TEST(StandardFloatingPoint, HoldsOnTheThreadsOfAParallelLoop) {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlushToZero | kDenormalsAreZero);
  std::atomic<int> flushed{0};
  parallel_for(Work(2), 100, 1,
               [&](std::int64_t, std::int64_t) { flushed += !keeps_subnormals(); });
  _mm_setcsr(before);
  EXPECT_EQ(flushed, 0);
}
#endif

TEST(Resources, ClocksDoNotRunBackwardsAndMemoryIsUsed) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  EXPECT_GE(wall_seconds(), wall);
  EXPECT_GE(cpu_seconds(), cpu);
#if defined(__unix__) || defined(__APPLE__)
  EXPECT_GT(peak_memory_bytes(), 100000u);
#endif
}

}  // namespace
}  // namespace beltrami
