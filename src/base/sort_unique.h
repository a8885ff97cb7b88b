// Lists of vertices or faces as sets.
#pragma once

#include <algorithm>
#include <vector>

namespace beltrami {

/// Puts the items into increasing order and leaves one of those that are equal.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace beltrami
