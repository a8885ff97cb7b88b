// A page as a grid of cells that are free or taken.
#pragma once

#include <array>
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
  /// Where the processor has wider vectors, they are used unless `wide` is false: for what is the
  /// same.
  Page(int width, int height, bool wide = true);

  /// A copy of a page for masks that ask for no more than `needs`.
  Page(const Page& page, const Needs& needs);

  /// Becomes such a copy, in the memory that it has.
  void assign(const Page& page, const Needs& needs);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return taken_ == 0; }
  /// Cells that are not taken.
  std::int64_t free_cells() const { return static_cast<std::int64_t>(width_) * height_ - taken_; }

  /// Rows that are looked at together.
  static constexpr int kRows = 8;
  /// Per row the first place, or -1.
  using Places = std::array<int, kRows>;

  /// For each of `rows` rows from y on the first x in [0, to] at which the mask is free with its
  /// lower side there; false where all have none. Precondition: rows in [1, kRows], the mask fits
  /// into the page there, and has cells. Counts what it does in `steps`.
  bool first_free(const Mask& mask, int y, int rows, int to, Places& places,
                  std::int64_t& steps) const;

  /// How many rows from y to `last` it is best to look at together: up to where skip_full_rows
  /// tells of the next.
  static int rows_together(const Mask& mask, int y, int last);

  /// The first row from y to `last` at which the mask's first square may be free with the mask's
  /// left side at or before `to`, or one after `last`: what it skips is full.
  int skip_full_rows(const Mask& mask, int y, int last, int to, std::int64_t& steps) const;

  /// Takes the mask's cells; those that are taken stay so. `later` bounds what is looked for from
  /// now on: the page keeps no more than these need.
  void take(const Mask& mask, int x, int y, const Needs& later = {});

 private:
  using Word = std::uint64_t;
  static constexpr int kBits = 64;

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
    return words.data() + static_cast<std::size_t>(w) * stride_;
  }
  Word* column(Bits& words, int w) { return words.data() + static_cast<std::size_t>(w) * stride_; }
  template <int kLanes>
  struct Free;
  template <int kLanes>
  bool keep_free(const Bits& words, int w, int y, int shift, Free<kLanes>& free) const;
  template <int kLanes>
  bool free_places(const Mask& mask, int y, int w, Free<kLanes>& free, std::int64_t& steps) const;
  template <int kLanes>
  Word parts_together(const Mask& mask, int y, int to) const;
  template <int kLanes>
  bool find_first(const Mask& mask, int y, int rows, int to, Places& places,
                  std::int64_t& steps) const;
  bool find_first_wide(const Mask& mask, int y, int rows, int to, Places& places,
                       std::int64_t& steps) const;
  Word parts_before(Word open, const Square& square) const;
  Word first_parts(int to) const;
  void raise(const Changed& changed, const Needs& needs);
  void raise_wide(const Changed& changed, const Needs& needs);
  void raise_runs(const Changed& changed, const Needs& needs);
  void raise_squares(const Changed& changed, const Needs& needs);
  void raise_squares(int level, int w, int from, int high);
  void find_open(Squares& squares, const Changed& rows, int begin, int end);

  int width_ = 0, height_ = 0, words_ = 0, band_count_ = 0;
  int stride_ = 0;     // rows of a column: some more than the page has may be looked at
  bool wide_ = false;  // vectors of the processor
  int part_bits_ = 0;  // a part has 2^this cells: 64 of them are a row or more
  std::int64_t taken_ = 0;
  std::vector<Bits> runs_;  // by level
  std::vector<Squares> squares_;
};

}  // namespace beltrami
