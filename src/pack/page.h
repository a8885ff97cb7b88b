// A page as a grid of cells that are free or taken.
#pragma once

#include <cstdint>
#include <vector>

#include "pack/mask.h"

namespace beltrami {

/// For each cell and each k the page keeps as bits whether one of the 2^k cells from it on to the
/// right is taken, and whether one of the 2^k x 2^k cells to the right and above is: whether a run
/// or a square of cells is free, at 64 places at once, is a few words.
class Page {
 public:
  Page(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return taken_ == 0; }
  /// Cells that are not taken.
  std::int64_t free_cells() const { return static_cast<std::int64_t>(width_) * height_ - taken_; }

  /// The first x in [0, to] at which the mask is free with its lower side at y; -1 for none.
  /// Precondition: the mask fits into the page there, and has cells. Counts what it does in
  /// `steps`.
  int first_free(const Mask& mask, int y, int to, std::int64_t& steps) const;

  /// The first row from y to `last` at which the mask's first square may be free with the mask's
  /// left side at or before `to`, or one after `last`: what it skips is full.
  int skip_full_rows(const Mask& mask, int y, int last, int to, std::int64_t& steps) const;

  /// Takes the mask's cells; those that are taken stay so.
  void take(const Mask& mask, int x, int y);

 private:
  using Word = std::uint64_t;
  static constexpr int kBits = 64;
  static constexpr int kBand = 8;  // rows that are skipped together

  /// Rows of bits by level; beyond the page all are taken.
  struct Level {
    std::vector<Word> runs, squares;
    std::vector<Word> bands;  // the squares that are taken in each row of a band
  };

  const Word* line(const std::vector<Word>& rows, int y) const {
    return rows.data() + static_cast<std::size_t>(y) * words_;
  }
  Word* line(std::vector<Word>& rows, int y) {
    return rows.data() + static_cast<std::size_t>(y) * words_;
  }
  /// The cells that have changed.
  struct Changed {
    int left = 0, right = 0, low = 0, high = 0;  // the last ones included
  };
  void raise_runs(const Changed& changed, int y);
  void raise_squares(const Changed& changed);

  int width_, height_, words_, band_count_;
  std::int64_t taken_ = 0;
  std::vector<Level> levels_;
};

}  // namespace beltrami
