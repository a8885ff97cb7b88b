// Blocks of vertices that are simplified side by side; and what reaches from one into another, in
// rounds of pairs of blocks of which no two have one in common. Neither depends on the number of
// threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/types.h"

namespace beltrami {

/// The greatest blocks of which there are so many; those of the least size may be fewer.
inline int block_shift(Index vertices, Index blocks) {
  constexpr int kLeast = 10, kMost = 14;
  int shift = kMost;
  while (shift > kLeast && vertices >> shift < blocks) --shift;
  return shift;
}

/// The vertices that what is under way may look at and change: those of a block of 2^shift, or of
/// two; or all.
class Territory {
 public:
  static Territory of_block(int shift, Index block) { return of_pair(shift, block, block); }
  static Territory of_pair(int shift, Index one, Index other) {
    return {shift, one << shift, other << shift, std::uint32_t{1} << shift};
  }
  static Territory all() { return {0, 0, 0, std::numeric_limits<std::uint32_t>::max()}; }

  bool has(Index v) const {
    return static_cast<std::uint32_t>(v - one_) < size_ ||
           static_cast<std::uint32_t>(v - other_) < size_;
  }
  Index block_of(Index v) const { return v >> shift_; }

 private:
  Territory(int shift, Index one, Index other, std::uint32_t size)
      : shift_(shift), one_(one), other_(other), size_(size) {}

  int shift_;
  Index one_, other_;   // the first vertices
  std::uint32_t size_;  // of a block
};

/// What a block has left since it reaches out of it, by the block that it reaches into.
template <class Item>
class ReachingOut {
 public:
  struct Into {
    Index block;
    std::vector<Item> items;
  };

  void add(Index block, const Item& item) {
    auto at =
        std::find_if(into_.begin(), into_.end(), [&](const Into& i) { return i.block == block; });
    if (at == into_.end()) at = into_.insert(at, Into{block, {}});
    at->items.push_back(item);
  }
  const std::vector<Into>& into() const { return into_; }

 private:
  std::vector<Into> into_;  // few blocks lie next to one
};

/// Two blocks, and what each has that reaches into the other.
template <class Item>
struct BlockPair {
  Index one, other;  ///< one < other
  std::vector<const std::vector<Item>*> items;

  std::size_t size() const {
    std::size_t sum = 0;
    for (const auto* list : items) sum += list->size();
    return sum;
  }
};

/// The pairs in rounds, those with most to do first; in a round no block is in two of them.
template <class Item>
std::vector<std::vector<BlockPair<Item>>> rounds_of_pairs(
    const std::vector<ReachingOut<Item>>& of_block) {
  std::vector<BlockPair<Item>> pairs;
  for (Index b = 0; b < size_of(of_block); ++b) {
    for (const auto& [block, items] : of_block[b].into()) {
      pairs.push_back({std::min(b, block), std::max(b, block), {&items}});
    }
  }
  const auto ends = [](const BlockPair<Item>& pair) { return std::pair(pair.one, pair.other); };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const auto& a, const auto& b) { return ends(a) < ends(b); });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (kept > 0 && ends(pairs[kept - 1]) == ends(pairs[i])) {
      pairs[kept - 1].items.push_back(pairs[i].items.front());
    } else {
      if (kept != i) pairs[kept] = std::move(pairs[i]);
      ++kept;
    }
  }
  pairs.resize(kept);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<std::vector<BlockPair<Item>>> rounds;
  std::vector<std::vector<bool>> taken;  // per round and block
  for (BlockPair<Item>& pair : pairs) {
    std::size_t round = 0;
    while (round < rounds.size() && (taken[round][pair.one] || taken[round][pair.other])) ++round;
    if (round == rounds.size()) {
      rounds.emplace_back();
      taken.emplace_back(of_block.size(), false);
    }
    taken[round][pair.one] = taken[round][pair.other] = true;
    rounds[round].push_back(std::move(pair));
  }
  return rounds;
}

}  // namespace beltrami
