// Sets of items that become one where two of them meet.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Sets as trees (Tarjan 1975); the least item of each is its root. Each item is made a set of its
/// own before it is used. Threads may work on items that never meet.
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) {}
  DisjointSets(Index count, const Work& work) {
    parallel_assign(work, parent_, static_cast<std::size_t>(count));
  }

  void make(Index item) { parent_[item] = item; }
  /// Made as one of the set of a root less than it.
  void make(Index item, Index root) { parent_[item] = root; }
  Index root(Index item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// Whether they were two sets.
  bool unite(Index one, Index other) {
    one = root(one);
    other = root(other);
    parent_[std::max(one, other)] = std::min(one, other);
    return one != other;
  }

  /// Whether they are of one set as far as one look tells.
  bool have_one_parent(Index one, Index other) const { return parent_[one] == parent_[other]; }
  /// As unite, where other threads do so with items that may meet.
  void unite_beside_others(Index one, Index other) {
    for (;;) {
      one = root_beside_others(one);
      other = root_beside_others(other);
      if (one == other) return;
      if (one < other) std::swap(one, other);
      Index expected = one;
      if (std::atomic_ref(parent_[one]).compare_exchange_strong(expected, other, kRelaxed)) return;
    }
  }

  /// Per item its root. Precondition: each was made.
  std::vector<Index> roots() && {
    PollSometimes poll;
    for (Index& parent : parent_) {  // no greater than its child
      poll();
      parent = parent_[parent];
    }
    return std::move(parent_);
  }
  std::vector<Index> roots(const Work& work) && {
    constexpr std::int64_t kGrain = 16384;
    parallel_for(work, size_of(parent_), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (auto item = static_cast<Index>(begin); item < end; ++item) {
        const Index own = root_beside_others(item);
        std::atomic_ref(parent_[item]).store(own, kRelaxed);
      }
    });
    return std::move(parent_);
  }

 private:
  static constexpr auto kRelaxed = std::memory_order_relaxed;

  /// What is written is another item on the way, whoever does so.
  Index root_beside_others(Index item) {
    for (;;) {
      const Index parent = std::atomic_ref(parent_[item]).load(kRelaxed);
      if (parent == item) return item;
      const Index next = std::atomic_ref(parent_[parent]).load(kRelaxed);
      if (next != parent) std::atomic_ref(parent_[item]).store(next, kRelaxed);
      item = next;
    }
  }

  std::vector<Index> parent_;
};

}  // namespace beltrami
