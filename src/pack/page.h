// A page as a grid of cells that are free or taken.
#pragma once

#include <cstdint>
#include <vector>

#include "pack/mask.h"

namespace beltrami {

/// For each cell and each k the page keeps as bits whether one of the 2^k cells from it on to the
/// right is taken, and whether one of the 2^k x 2^k cells to the right and above is: whether a run
/// or a square of cells is free, at 64 places at once, is a few words. Of each row a word more says
/// in which parts of it a square may be free at all.
class Page {
 public:
  Page(int width, int height);

  /// A copy of a page for masks that ask for no more than `needs`.
  Page(const Page& page, const Needs& needs);

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

  /// Takes the mask's cells; those that are taken stay so. `later` bounds what is looked for from
  /// now on: the page keeps no more than these need.
  void take(const Mask& mask, int x, int y, const Needs& later = {});

 private:
  using Word = std::uint64_t;
  static constexpr int kBits = 64;
  static constexpr int kBand = 8;  // rows that are skipped together

  /// Bits, by words of 64 cells of a row; beyond the page all are taken.
  using Bits = std::vector<Word>;
  struct Squares {
    Bits taken;
    /// Per row, and per band of rows, the parts in which a square is free: part i is cells
    /// [i, i + 1) 2^part_bits_.
    std::vector<Word> open, open_bands;
  };
  /// The cells that have changed.
  struct Changed {
    int left = 0, right = 0, low = 0, high = 0;  // the last ones included
  };

  /// Word w of all rows: what is near in rows is looked at together.
  const Word* column(const Bits& words, int w) const {
    return words.data() + static_cast<std::size_t>(w) * height_;
  }
  Word* column(Bits& words, int w) { return words.data() + static_cast<std::size_t>(w) * height_; }
  Word bits_from(const Bits& words, int w, int y, int shift) const;
  Word parts_before(Word open, const Square& square) const;
  Word first_parts(int to) const;
  Word free_places(const Mask& mask, int y, int w, Word free, std::int64_t& steps) const;
  void raise_runs(const Changed& changed, const Needs& needs);
  void raise_squares(const Changed& changed, const Needs& needs);
  void raise_squares(int level, int w, int from, int high);
  void find_open(Squares& squares, const Changed& rows, int begin, int end);

  int width_, height_, words_, band_count_;
  int part_bits_ = 0;  // a part has 2^this cells: 64 of them are a row or more
  std::int64_t taken_ = 0;
  std::vector<Bits> runs_;  // by level
  std::vector<Squares> squares_;
};

}  // namespace beltrami
