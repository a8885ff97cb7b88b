// Sets of items that become one where two of them meet.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"

namespace beltrami {

/// Sets as trees (Tarjan 1975); the least item of each is its root. Each item is made a set of its
/// own before it is used. Threads may work on items that never meet.
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(count) {}

  void make(Index item) { parent_[item] = item; }
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

  /// Per item its root. Precondition: each was made.
  std::vector<Index> roots() && {
    PollSometimes poll;
    for (Index& parent : parent_) {  // no greater than its child
      poll();
      parent = parent_[parent];
    }
    return std::move(parent_);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace beltrami
