// Lists of vertices or faces as sets.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "base/interrupt.h"

namespace beltrami {

/// Puts the items into increasing order and leaves one of those that are equal. Polls.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  sort_interruptibly(items.begin(), items.end(), std::less<>());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace beltrami
