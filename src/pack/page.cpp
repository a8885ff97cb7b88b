#include "pack/page.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/compiler.h"
#include "base/processor.h"

namespace beltrami {
namespace {

using Word = std::uint64_t;
constexpr int kBits = 64, kWordBits = 6;

/// Whether a bit of them all is set.
template <int kLanes>
BELTRAMI_INLINE bool any_of(const Register<Word, kLanes>& words) {
  Word any = 0;
  BELTRAMI_UNROLL(4)
  for (int k = 0; k < kLanes; ++k) any |= words[k];
  return any != 0;
}

int log2_of(int x) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(x))) - 1;
}

}  // namespace

BELTRAMI_INLINE void Page::raise_runs(const Changed& changed, const Needs& needs) {
  const Bits full(stride_, ~Word{0});
  const int levels = static_cast<int>(runs_.size());
  for (int level = 1; level < levels && level <= needs.run_level; ++level) {
    const Bits& below = runs_[level - 1];
    const int half = 1 << (level - 1), skip = half / kBits, rest = half % kBits;
    const int begin = std::max(changed.left - 2 * half + 1, 0) / kBits;
    for (int w = begin; w <= changed.right / kBits; ++w) {
      const auto at = [&](int i) { return i < words_ ? column(below, i) : full.data(); };
      const Word *const here = at(w), *const low = at(w + skip), *const high = at(w + skip + 1);
      Word* const words = column(runs_[level], w);
      for (int y = changed.low; y <= changed.high; ++y) {
        words[y] = here[y] | low[y] >> rest | high[y] << 1 << (kBits - 1 - rest);
      }
    }
  }
}

/// A word of the squares of rows, of those of half the side at the four corners.
BELTRAMI_INLINE void Page::raise_squares(int level, int w, int from, int high) {
  Word* const words = column(squares_[level].taken, w);
  const int half = (1 << level) / 2;
  const int end = std::min(high + 1, height_ - 2 * half + (level == 0 ? 0 : 1));
  if (level == 0) {
    const Word* const row = column(runs_[0], w);
    std::copy(row + from, row + end, words + from);
    return;
  }
  const Bits& below = squares_[level - 1].taken;
  const int rest = half % kBits;
  const Word* const first = column(below, std::min(w + half / kBits, words_ - 1));
  const Word* const second = column(below, std::min(w + half / kBits + 1, words_ - 1));
  const Word* const here = column(below, w);
  for (int y = from; y < end; ++y) {
    const Word left = first[y] | first[y + half], right = second[y] | second[y + half];
    words[y] = here[y] | here[y + half] | left >> rest | right << 1 << (kBits - 1 - rest);
  }
  for (int y = std::max(from, end); y <= high; ++y) words[y] = ~Word{0};
}

/// Which parts of rows have a free square; what is taken stays so, and they only become fewer.
BELTRAMI_INLINE void Page::find_open(Squares& squares, const Changed& rows, int begin, int end) {
  if (part_bits_ >= kWordBits) {
    const int words_of_part = 1 << (part_bits_ - kWordBits);
    for (int part = begin / words_of_part; part * words_of_part < end && part < kBits; ++part) {
      const int first = part * words_of_part, after = std::min(first + words_of_part, words_);
      for (int y = rows.low; y <= rows.high; ++y) {
        Word taken = ~Word{0};
        for (int w = first; w < after; ++w) taken &= column(squares.taken, w)[y];
        if (taken == ~Word{0}) squares.open[y] &= ~(Word{1} << part);
      }
    }
    return;
  }
  const int parts_of_word = kBits >> part_bits_;
  for (int part = begin * parts_of_word; part < end * parts_of_word && part < kBits; ++part) {
    const Word* const words = column(squares.taken, part / parts_of_word);
    const Word all = ~Word{0} >> (kBits - (1 << part_bits_))
                                     << (part % parts_of_word << part_bits_);
    const Word other = ~(Word{1} << part);
    Word* const open = squares.open.data();
    for (int y = rows.low; y <= rows.high; ++y) {
      open[y] &= other | ((words[y] & all) == all ? Word{0} : ~Word{0});
    }
  }
}

/// Squares and runs reach right and up: those to the left and below see what has changed.
BELTRAMI_INLINE void Page::raise_squares(const Changed& changed, const Needs& needs) {
  const int levels = static_cast<int>(squares_.size());
  for (int level = 0; level < levels && level <= needs.square_level; ++level) {
    Squares& squares = squares_[level];
    const int reach = 1 << level;
    const int begin = std::max(0, changed.left - reach + 1) / kBits,
              end = changed.right / kBits + 1;
    const Changed rows{0, 0, std::max(0, changed.low - reach + 1), changed.high};
    for (int w = begin; w < end; ++w) raise_squares(level, w, rows.low, rows.high);
    find_open(squares, rows, begin, end);
    for (int b = rows.low / kRows; b <= rows.high / kRows; ++b) {
      Word open = 0;
      for (int y = b * kRows; y < std::min((b + 1) * kRows, height_); ++y) open |= squares.open[y];
      squares.open_bands[b] = open;
    }
  }
}

#if BELTRAMI_DISPATCH_AVX2
BELTRAMI_FOR_AVX2 void Page::raise_wide(const Changed& changed, const Needs& needs) {
  raise_runs(changed, needs);
  raise_squares(changed, needs);
}
#endif

void Page::raise(const Changed& changed, const Needs& needs) {
#if BELTRAMI_DISPATCH_AVX2
  if (wide_) {
    raise_wide(changed, needs);
    return;
  }
#endif
  raise_runs(changed, needs);
  raise_squares(changed, needs);
}

Page::Page(int width, int height, bool wide)
    : width_(width),
      height_(height),
      words_((width + kBits - 1) / kBits + 2),
      band_count_((height + kRows - 1) / kRows),
      stride_(height + kRows),
      wide_(wide && has_avx2()),
      runs_(log2_of(width) + 1, Bits(static_cast<std::size_t>(words_) * stride_, 0)),
      squares_(std::min(log2_of(width), kSquareLevels) + 1,
               {runs_[0], std::vector<Word>(stride_, ~Word{0}),
                std::vector<Word>(band_count_, ~Word{0})}) {
  while (kBits << part_bits_ < width) ++part_bits_;
  for (int x = width; x < words_ * kBits; ++x) {
    Word* const words = column(runs_[0], x / kBits);
    for (int y = 0; y < height; ++y) words[y] |= Word{1} << x % kBits;
  }
  const Changed all{0, words_ * kBits - 1, 0, height - 1};
  raise(all, {});
}

Page::Page(const Page& page, const Needs& needs) {
  assign(page, needs);
}

void Page::assign(const Page& page, const Needs& needs) {
  width_ = page.width_;
  height_ = page.height_;
  words_ = page.words_;
  band_count_ = page.band_count_;
  stride_ = page.stride_;
  wide_ = page.wide_;
  part_bits_ = page.part_bits_;
  taken_ = page.taken_;
  // What there is beyond is not asked for.
  const auto copy = [](const auto& from, int top, auto& to) {
    const std::size_t count = std::min(from.size(), static_cast<std::size_t>(top) + 1);
    if (to.size() < count) to.resize(count);
    std::copy(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count), to.begin());
  };
  copy(page.runs_, needs.run_level, runs_);
  copy(page.squares_, needs.square_level, squares_);
}

/// The parts of a row that have places of a mask whose square is in the open parts.
Page::Word Page::parts_before(Word open, const Square& square) const {
  const Word parts = open >> (square.x >> part_bits_);
  const bool aligned = (square.x & ((1 << part_bits_) - 1)) == 0;
  return aligned ? parts : parts | parts >> 1;
}

/// The parts of a row from the first to that of a place.
Page::Word Page::first_parts(int to) const {
  return ~Word{0} >> (kBits - 1 - (to >> part_bits_));
}

int Page::skip_full_rows(const Mask& mask, int y, int last, int to, std::int64_t& steps) const {
  if (mask.squares.empty()) return y;
  const Square& square = mask.squares.front();
  const std::vector<Word>& open = squares_[square.level].open_bands;
  const Word parts = first_parts(to);
  while (y <= last && (y + square.y) % kRows == 0) {
    ++steps;
    if ((parts_before(open[(y + square.y) / kRows], square) & parts) != 0) return y;
    y += kRows;
  }
  return y;
}

int Page::rows_together(const Mask& mask, int y, int last) {
  const int up = mask.squares.empty() ? y : y + mask.squares.front().y;
  return std::min(kRows - up % kRows, last - y + 1);
}

/// Of 64 places in each of some rows those that are free, in registers.
template <int kLanes>
struct Page::Free {
  static constexpr int kVectors = kRows / kLanes;
  using Vector = Register<Word, kLanes>;
  Vector of[kVectors];

  BELTRAMI_INLINE bool any() const {
    Vector all = of[0];
    BELTRAMI_UNROLL(4)
    for (int v = 1; v < kVectors; ++v) all |= of[v];
    return any_of<kLanes>(all);
  }
};

/// Leaves the places from cell 64 w on in the rows from y on at which the cell `shift` to the right
/// is not taken; false where none is left. Shifts by 64 are none: the word above takes two.
template <int kLanes>
BELTRAMI_INLINE bool Page::keep_free(const Bits& words, int w, int y, int shift,
                                     Free<kLanes>& free) const {
  const Word* const first = column(words, w + shift / kBits) + y;
  const Word* const second = first + stride_;
  const int rest = shift % kBits, up = kBits - 1 - rest;
  BELTRAMI_UNROLL(4)
  for (int v = 0; v < Free<kLanes>::kVectors; ++v) {
    typename Free<kLanes>::Vector low, high;
    std::memcpy(&low, first + v * kLanes, sizeof low);
    std::memcpy(&high, second + v * kLanes, sizeof high);
    free.of[v] &= ~(low >> rest | high << 1 << up);
  }
  return free.any();
}

/// Leaves those places at which the mask is free.
template <int kLanes>
BELTRAMI_INLINE bool Page::free_places(const Mask& mask, int y, int w, Free<kLanes>& free,
                                       std::int64_t& steps) const {
  for (const Square& square : mask.squares) {
    ++steps;
    if (!keep_free(squares_[square.level].taken, w, y + square.y, square.x, free)) return false;
  }
  for (const Probe& probe : mask.probes) {
    const Bits& runs = runs_[probe.level];
    steps += 2;
    if (!keep_free(runs, w, y + probe.row, probe.left, free)) return false;
    if (probe.right != probe.left && !keep_free(runs, w, y + probe.row, probe.right, free)) {
      return false;
    }
  }
  return true;
}

/// The parts up to that of a place in which one of the rows from y on may have the mask's squares
/// free.
template <int kLanes>
BELTRAMI_INLINE Page::Word Page::parts_together(const Mask& mask, int y, int to) const {
  using Vector = typename Free<kLanes>::Vector;
  Free<kLanes> free;
  for (Vector& vector : free.of) fill(first_parts(to), vector);
  for (const Square& square : mask.squares) {
    const Word* const open = squares_[square.level].open.data() + y + square.y;
    const int shift = square.x >> part_bits_;
    // Of a part that begins between two the first or the second has what is in it.
    const int more = (square.x & ((1 << part_bits_) - 1)) == 0 ? 0 : 1;
    BELTRAMI_UNROLL(4)
    for (int v = 0; v < Free<kLanes>::kVectors; ++v) {
      Vector parts;
      std::memcpy(&parts, open + v * kLanes, sizeof parts);
      parts = parts >> shift;
      free.of[v] &= parts | parts >> more;
    }
  }
  Word any = 0;
  for (const Vector& vector : free.of) {
    for (int k = 0; k < kLanes; ++k) any |= vector[k];
  }
  return any;
}

template <int kLanes>
BELTRAMI_INLINE bool Page::find_first(const Mask& mask, int y, int rows, int to, Places& places,
                                      std::int64_t& steps) const {
  const Word parts = parts_together<kLanes>(mask, y, to);
  ++steps;
  if (parts == 0) return false;
  places.fill(-1);
  int missing = rows;
  const int end_word = to / kBits;
  for (Word left = parts; left != 0;) {
    const int cell = std::countr_zero(left) << part_bits_;
    const int begin = cell / kBits, end = std::max(begin + 1, (cell + (1 << part_bits_)) / kBits);
    for (int w = begin; w < end && w <= end_word; ++w) {
      const Word all = w == end_word ? ~Word{0} >> (kBits - 1 - to % kBits) : ~Word{0};
      Free<kLanes> free;
      for (auto& vector : free.of) fill(all, vector);
      if (!free_places(mask, y, w, free, steps)) continue;
      std::array<Word, kRows> found;
      std::memcpy(found.data(), free.of, sizeof found);
      for (int k = 0; k < rows; ++k) {
        if (found[k] == 0 || places[k] >= 0) continue;
        places[k] = w * kBits + std::countr_zero(found[k]);
        --missing;
      }
      if (missing == 0) return true;
    }
    // Those of the last word are done.
    const int done = end * kBits >> part_bits_;
    left = done < kBits ? left >> done << done : 0;
  }
  return missing < rows;
}

#if BELTRAMI_DISPATCH_AVX2
BELTRAMI_FOR_AVX2 bool Page::find_first_wide(const Mask& mask, int y, int rows, int to,
                                             Places& places, std::int64_t& steps) const {
  return find_first<4>(mask, y, rows, to, places, steps);
}
#endif

bool Page::first_free(const Mask& mask, int y, int rows, int to, Places& places,
                      std::int64_t& steps) const {
#if BELTRAMI_DISPATCH_AVX2
  if (wide_) return find_first_wide(mask, y, rows, to, places, steps);
#endif
  return find_first<2>(mask, y, rows, to, places, steps);
}

void Page::take(const Mask& mask, int x, int y, const Needs& later) {
  if (mask.runs.empty()) return;
  const Changed changed{x, std::min(x + mask.width, width_) - 1, y + mask.runs.front().row,
                        y + mask.runs.back().row};
  for (const Run& run : mask.runs) {
    const int begin = x + run.begin, end = x + run.end;
    for (int w = begin / kBits; w <= (end - 1) / kBits; ++w) {
      const int low = std::max(begin - w * kBits, 0), high = std::min(end - w * kBits, kBits);
      const Word bits = (high == kBits ? ~Word{0} : (Word{1} << high) - 1) & (~Word{0} << low);
      Word& word = column(runs_[0], w)[y + run.row];
      taken_ += std::popcount(bits & ~word);
      word |= bits;
    }
  }
  raise(changed, later);
}

}  // namespace beltrami
