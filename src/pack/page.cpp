#include "pack/page.h"

#include <algorithm>
#include <bit>

namespace beltrami {
namespace {

using Word = std::uint64_t;
constexpr int kBits = 64, kWordBits = 6;

int log2_of(int x) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(x))) - 1;
}

}  // namespace

/// 64 cells of row y from the one `shift` after cell 64 w on. Shifts by 64 are none: the word above
/// takes two.
Page::Word Page::bits_from(const Bits& words, int w, int y, int shift) const {
  const Word* const word = column(words, w + shift / kBits) + y;
  const int rest = shift % kBits;
  return word[0] >> rest | word[height_] << 1 << (kBits - 1 - rest);
}

Page::Page(int width, int height)
    : width_(width),
      height_(height),
      words_((width + kBits - 1) / kBits + 2),
      band_count_((height + kBand - 1) / kBand),
      runs_(log2_of(width) + 1, Bits(static_cast<std::size_t>(words_) * height, 0)),
      squares_(std::min(log2_of(width), kSquareLevels) + 1,
               {runs_[0], std::vector<Word>(height, ~Word{0}),
                std::vector<Word>(band_count_, ~Word{0})}) {
  while (kBits << part_bits_ < width) ++part_bits_;
  for (int x = width; x < words_ * kBits; ++x) {
    Word* const words = column(runs_[0], x / kBits);
    for (int y = 0; y < height; ++y) words[y] |= Word{1} << x % kBits;
  }
  const Changed all{0, words_ * kBits - 1, 0, height - 1};
  raise_runs(all, {});
  raise_squares(all, {});
}

Page::Page(const Page& page, const Needs& needs)
    : width_(page.width_),
      height_(page.height_),
      words_(page.words_),
      band_count_(page.band_count_),
      part_bits_(page.part_bits_),
      taken_(page.taken_) {
  const auto first = [](const auto& levels, int top) {
    const auto count = static_cast<std::ptrdiff_t>(levels.size());
    return std::vector(levels.begin(), levels.begin() + std::min(count, std::ptrdiff_t{top} + 1));
  };
  runs_ = first(page.runs_, needs.run_level);
  squares_ = first(page.squares_, needs.square_level);
}

void Page::raise_runs(const Changed& changed, const Needs& needs) {
  const Bits full(height_, ~Word{0});
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
void Page::raise_squares(int level, int w, int from, int high) {
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
void Page::find_open(Squares& squares, const Changed& rows, int begin, int end) {
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
  const Word all = ~Word{0} >> (kBits - parts_of_word);
  for (int w = begin; w < end && w * parts_of_word < kBits; ++w) {
    const Word* const words = column(squares.taken, w);
    for (int y = rows.low; y <= rows.high; ++y) {
      // The lowest bit of each part becomes that of all of it.
      Word free = ~words[y];
      for (int bit = 0; bit < part_bits_; ++bit) free |= free >> (1 << bit);
      Word parts = 0;
      for (int k = 0; k < parts_of_word; ++k) parts |= (free >> (k << part_bits_) & 1) << k;
      squares.open[y] &= ~((all & ~parts) << w * parts_of_word);
    }
  }
}

/// Squares and runs reach right and up: those to the left and below see what has changed.
void Page::raise_squares(const Changed& changed, const Needs& needs) {
  const int levels = static_cast<int>(squares_.size());
  for (int level = 0; level < levels && level <= needs.square_level; ++level) {
    Squares& squares = squares_[level];
    const int reach = 1 << level;
    const int begin = std::max(0, changed.left - reach + 1) / kBits,
              end = changed.right / kBits + 1;
    const Changed rows{0, 0, std::max(0, changed.low - reach + 1), changed.high};
    for (int w = begin; w < end; ++w) raise_squares(level, w, rows.low, rows.high);
    find_open(squares, rows, begin, end);
    for (int b = rows.low / kBand; b <= rows.high / kBand; ++b) {
      Word open = 0;
      for (int y = b * kBand; y < std::min((b + 1) * kBand, height_); ++y) open |= squares.open[y];
      squares.open_bands[b] = open;
    }
  }
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
  while (y <= last && (y + square.y) % kBand == 0) {
    ++steps;
    if ((parts_before(open[(y + square.y) / kBand], square) & parts) != 0) return y;
    y += kBand;
  }
  return y;
}

/// Those of 64 places, from cell 64 w of row y on, at which the mask is free.
Page::Word Page::free_places(const Mask& mask, int y, int w, Word free, std::int64_t& steps) const {
  for (const Square& square : mask.squares) {
    free &= ~bits_from(squares_[square.level].taken, w, y + square.y, square.x);
    ++steps;
    if (free == 0) return 0;
  }
  for (const Probe& probe : mask.probes) {
    const Bits& runs = runs_[probe.level];
    free &= ~(bits_from(runs, w, y + probe.row, probe.left) |
              bits_from(runs, w, y + probe.row, probe.right));
    steps += 2;
    if (free == 0) return 0;
  }
  return free;
}

int Page::first_free(const Mask& mask, int y, int to, std::int64_t& steps) const {
  Word parts = first_parts(to);
  for (const Square& square : mask.squares) {
    parts &= parts_before(squares_[square.level].open[y + square.y], square);
  }
  ++steps;
  const int end_word = to / kBits;
  while (parts != 0) {
    const int cell = std::countr_zero(parts) << part_bits_;
    const int begin = cell / kBits, end = std::max(begin + 1, (cell + (1 << part_bits_)) / kBits);
    for (int w = begin; w < end && w <= end_word; ++w) {
      const Word places = w == end_word ? ~Word{0} >> (kBits - 1 - to % kBits) : ~Word{0};
      const Word free = free_places(mask, y, w, places, steps);
      if (free != 0) return w * kBits + std::countr_zero(free);
    }
    // Those of the last word are done.
    const int done = end * kBits >> part_bits_;
    parts = done < kBits ? parts >> done << done : 0;
  }
  return -1;
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
  raise_runs(changed, later);
  raise_squares(changed, later);
}

}  // namespace beltrami
