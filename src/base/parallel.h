// Data-parallel loops whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Calls `body(begin, end)` over [0, count) in chunks of `grain`, on the threads of the run that
/// `work` allows; in the body of another loop of that run, on its thread alone. Chunk borders
/// depend on `count` and `grain` only, so a body that writes per-item or per-chunk results gives
/// the same bits at any thread count. The first exception thrown by a body is rethrown here, after
/// all threads have stopped; so is the one by which a run ends that is cancelled (poll_interrupt).
void parallel_for(const Work& work, std::int64_t count, std::int64_t grain,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// Lets several threads be the first to touch memory, which costs more than to fill it.
void touch_memory(const Work& work, void* memory, std::size_t bytes);

/// Empties a large array, with room for `count` items in memory that several threads have touched.
template <class T>
void parallel_reserve(const Work& work, std::vector<T>& items, std::size_t count) {
  items.clear();
  if (items.capacity() >= count) return;
  std::vector<T>().swap(items);
  items.reserve(count);
  touch_memory(work, items.data(), count * sizeof(T));
}

/// Lets several threads give memory back, which costs as much; its items are lost, and the array is
/// to be freed.
void release_memory(const Work& work, void* memory, std::size_t bytes);

/// Frees a large array.
template <class T>
void parallel_free(const Work& work, std::vector<T>& items) {
  static_assert(std::is_trivially_destructible_v<T>);
  release_memory(work, items.data(), items.capacity() * sizeof(T));
  std::vector<T>().swap(items);
}

/// items.assign(count, value) for large arrays.
template <class T>
void parallel_assign(const Work& work, std::vector<T>& items, std::size_t count, const T& value) {
  parallel_reserve(work, items, count);
  items.assign(count, value);
}

/// `count` items as their default constructor leaves them: numbers are zero, which one thread alone
/// sees to; of Vec2, Vec3 and the like, which are left as they are, nothing is filled.
template <class T>
void parallel_assign(const Work& work, std::vector<T>& items, std::size_t count) {
  parallel_reserve(work, items, count);
  items.resize(count);
}

/// copy = items for large arrays.
template <class T>
void parallel_copy(const Work& work, const std::vector<T>& items, std::vector<T>& copy) {
  constexpr std::int64_t kBytes = std::int64_t{1} << 18;
  constexpr std::int64_t kGrain = kBytes / static_cast<std::int64_t>(sizeof(T));
  parallel_assign(work, copy, items.size());
  parallel_for(work, size_of(items), kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::copy(items.begin() + begin, items.begin() + end, copy.begin() + begin);
  });
}

/// The first of the items [0, count) for which `test` holds, or `count`.
template <class Test>
std::int64_t parallel_find(const Work& work, std::int64_t count, std::int64_t grain,
                           const Test& test) {
  std::atomic<std::int64_t> first{count};
  parallel_for(work, count, grain, [&](std::int64_t begin, std::int64_t end) {
    if (begin > first) return;
    std::int64_t i = begin;
    while (i < end && !test(i)) ++i;
    if (i == end) return;
    std::int64_t known = first;
    while (i < known && !first.compare_exchange_weak(known, i)) {
    }
  });
  return first;
}

/// The items [0, count) for which `test` holds, in order.
template <class Test>
std::vector<Index> parallel_filter(const Work& work, Index count, std::int64_t grain,
                                   const Test& test) {
  std::vector<std::vector<Index>> of_chunk(static_cast<std::size_t>((count + grain - 1) / grain));
  parallel_for(work, count, grain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Index>& found = of_chunk[static_cast<std::size_t>(begin / grain)];
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      if (test(i)) found.push_back(i);
    }
  });
  std::vector<std::size_t> start(of_chunk.size() + 1, 0);
  for (std::size_t c = 0; c < of_chunk.size(); ++c) start[c + 1] = start[c] + of_chunk[c].size();
  std::vector<Index> all;
  parallel_assign(work, all, start.back());
  parallel_for(work, size_of(of_chunk), 1, [&](std::int64_t c, std::int64_t) {
    std::copy(of_chunk[c].begin(), of_chunk[c].end(), all.begin() + start[c]);
  });
  return all;
}

/// Sum of `term(begin, end)` over fixed chunks, added in order: the same bits at any thread count.
double parallel_sum(const Work& work, std::int64_t count, std::int64_t grain,
                    const std::function<double(std::int64_t begin, std::int64_t end)>& term);

}  // namespace beltrami
