// A page as a grid of cells that are free or taken.
#pragma once

#include <cstdint>
#include <vector>

#include "base/types.h"
#include "pack/mask.h"

namespace beltrami {

/// For each cell and each k the page keeps whether one of the 2^k cells from it on to the right is
/// taken, as bits: whether a run of cells is free, at 64 places at once, is two words.
class Page {
 public:
  explicit Page(int cells);

  int cells() const { return cells_; }
  bool empty() const { return taken_ == 0; }
  /// Cells that are not taken.
  std::int64_t free_cells() const { return static_cast<std::int64_t>(cells_) * cells_ - taken_; }

  /// The first x in [from, to] at which the mask is free with its lower side at y; -1 for none.
  /// Precondition: the mask fits into the page there, and has cells. Counts what it does in
  /// `steps`.
  int first_free(const Mask& mask, int y, int from, int to, std::int64_t& steps) const;

  /// Takes the mask's cells; those that are taken stay so.
  void take(const Mask& mask, int x, int y);

 private:
  using Word = std::uint64_t;
  static constexpr int kBits = 64;

  const Word* row(int level, int y) const {
    return bits_.data() + (static_cast<std::size_t>(level) * cells_ + y) * words_;
  }
  Word* row(int level, int y) {
    return bits_.data() + (static_cast<std::size_t>(level) * cells_ + y) * words_;
  }
  void raise_levels(int y);

  int cells_, words_, levels_;
  std::int64_t taken_ = 0;
  std::vector<Word> bits_;  // by level, row and place; beyond the page all are taken
};

}  // namespace beltrami
