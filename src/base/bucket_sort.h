// Counting sort on several threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/work.h"

namespace beltrami {

/// Sorts the entries of `items` items stably into `buckets` buckets: entries of one bucket come in
/// the order of their items, whatever the number of threads. Count first, then place:
///   std::vector<Index> start;
///   BucketSort sort(work, items, buckets, start, [&](std::int64_t item, const auto& visit) {
///     visit(bucket); });                       // once for each entry of the item
///   sort.place([&](std::int64_t item, const auto& visit) { sorted[visit(bucket)] = entry; });
template <class Start>
class BucketSort {
 public:
  /// Sets start[b] to the number of entries before those of bucket b; buckets + 1 of them.
  template <class Each>
  BucketSort(const Work& work, std::int64_t items, std::int64_t buckets, std::vector<Start>& start,
             const Each& each)
      : work_(work), items_(items) {
    const std::int64_t parts = std::clamp<std::int64_t>(items / kLeastPart, 1, work.threads());
    cursors_.resize(static_cast<std::size_t>(std::min<std::int64_t>(parts, kMostParts)));
    for_each_part(
        [&](std::int64_t item, Start* counts) {
          each(item, [&](auto bucket) { ++counts[static_cast<std::size_t>(bucket)]; });
        },
        buckets);
    add_up(buckets, start);
  }

  /// `each` as above, but its `visit` returns the place of the entry. To be called once.
  template <class Each>
  void place(const Each& each) {
    for_each_part(
        [&](std::int64_t item, Start* cursor) {
          each(item, [&](auto bucket) { return cursor[static_cast<std::size_t>(bucket)]++; });
        },
        0);
  }

 private:
  // A part has counts of its own, one per bucket: as many as pay.
  static constexpr std::int64_t kLeastPart = 1 << 14, kMostParts = 16;
  static constexpr std::int64_t kGrain = 1 << 15;

  template <class Body>
  void for_each_part(const Body& body, std::int64_t buckets) {
    const auto parts = static_cast<std::int64_t>(cursors_.size());
    parallel_for(work_, parts, 1, [&](std::int64_t part, std::int64_t) {
      std::vector<Start>& cursor = cursors_[static_cast<std::size_t>(part)];
      if (buckets > 0) cursor.assign(static_cast<std::size_t>(buckets), 0);
      Start* const own = cursor.data();
      const std::int64_t end = items_ * (part + 1) / parts;
      for (std::int64_t begin = items_ * part / parts; begin < end; begin += kGrain) {
        poll_interrupt();
        const std::int64_t stop = std::min(begin + kGrain, end);
        for (std::int64_t item = begin; item < stop; ++item) body(item, own);
      }
    });
  }

  /// From counts to the first place of every bucket and part.
  void add_up(std::int64_t buckets, std::vector<Start>& start) {
    const std::size_t ends = static_cast<std::size_t>(buckets) + 1;
    if (start.capacity() < ends) parallel_reserve(work_, start, ends);
    start.resize(ends);
    std::vector<Start> before(static_cast<std::size_t>((buckets + kGrain - 1) / kGrain) + 1, 0);
    parallel_for(work_, buckets, kGrain, [&](std::int64_t begin, std::int64_t end) {
      Start sum = 0;
      for (const std::vector<Start>& counts : cursors_) {
        for (std::int64_t b = begin; b < end; ++b) sum += counts[b];
      }
      before[begin / kGrain + 1] = sum;
    });
    for (std::size_t block = 1; block < before.size(); ++block) before[block] += before[block - 1];
    parallel_for(work_, buckets, kGrain, [&](std::int64_t begin, std::int64_t end) {
      Start next = before[begin / kGrain];
      for (std::int64_t b = begin; b < end; ++b) {
        start[b] = next;
        for (std::vector<Start>& cursor : cursors_) {
          const Start count = cursor[b];
          cursor[b] = next;
          next += count;
        }
      }
    });
    start[static_cast<std::size_t>(buckets)] = before.back();
  }

  const Work work_;
  std::int64_t items_;
  std::vector<std::vector<Start>> cursors_;  // per part and bucket: counts, then next places
};

}  // namespace beltrami
