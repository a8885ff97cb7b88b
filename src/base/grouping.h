// Items by the group that each is in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/bucket_sort.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// The items [0, n) by their group, in increasing order in each.
class Grouping {
 public:
  /// `group_of(item)` in [0, groups), or kNone for an item in none.
  template <class GroupOf>
  Grouping(Index items, Index groups, const GroupOf& group_of, const Work& work)
      : items_(static_cast<std::size_t>(items)), places_(items_.size(), kNone) {
    const auto visit_group = [&](std::int64_t i, const auto& visit) {
      const Index group = group_of(static_cast<Index>(i));
      if (group != kNone) visit(group);
    };
    BucketSort<Index> sort(work, items, groups, start_, visit_group);
    sort.place([&](std::int64_t i, const auto& place) {
      visit_group(i, [&](Index group) {
        const Index at = place(group);
        items_[at] = static_cast<Index>(i);
        places_[i] = at - start_[group];
      });
    });
  }

  std::span<const Index> operator[](Index group) const {
    return std::span(items_).subspan(start_[group], start_[group + 1] - start_[group]);
  }
  /// The place of an item in its group.
  Index place(Index item) const { return places_[item]; }

 private:
  std::vector<Index> start_, items_, places_;
};

}  // namespace beltrami
