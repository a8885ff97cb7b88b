#include "pack/page.h"

#include <algorithm>
#include <array>
#include <bit>

namespace beltrami {
namespace {

using Word = std::uint64_t;
constexpr int kBits = 64;
constexpr int kMostWords = 128;  // free places that are looked at together

int log2_of(int x) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(x))) - 1;
}

/// A row of bits as it looks from `shift` bits on. Shifts by 64 are none: the word above takes two.
class Shifted {
 public:
  Shifted(const Word* row, int shift) : row_(row + shift / kBits), rest_(shift % kBits) {}
  Word operator[](int w) const {
    return row_[w] >> rest_ | row_[w + 1] << 1 << (kBits - 1 - rest_);
  }

 private:
  const Word* row_;
  int rest_;
};

/// Places of a row that are free still, and the words from the first to the last such.
struct FreePlaces {
  std::array<Word, kMostWords> words;
  int first, last;

  bool none() const { return first > last; }
  void narrow() {
    while (first <= last && words[first] == 0) ++first;
    while (last >= first && words[last] == 0) --last;
  }
};

}  // namespace

Page::Page(int width, int height)
    : width_(width),
      height_(height),
      words_((width + kBits - 1) / kBits + 2),
      band_count_((height + kBand - 1) / kBand),
      levels_(log2_of(width) + 1) {
  for (int level = 0; level < static_cast<int>(levels_.size()); ++level) {
    levels_[level].runs.assign(static_cast<std::size_t>(words_) * height, 0);
    if (level > kSquareLevels) continue;
    levels_[level].squares.assign(static_cast<std::size_t>(words_) * height, 0);
    levels_[level].bands.assign(static_cast<std::size_t>(words_) * band_count_, 0);
  }
  const Changed all{0, words_ * kBits - 1, 0, height - 1};
  for (int y = 0; y < height; ++y) {
    Word* const words = line(levels_[0].runs, y);
    for (int x = width; x < words_ * kBits; ++x) words[x / kBits] |= Word{1} << x % kBits;
    raise_runs(all, y);
  }
  raise_squares(all);
}

void Page::raise_runs(const Changed& changed, int y) {
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const Word* const below = line(levels_[level - 1].runs, y);
    Word* const words = line(levels_[level].runs, y);
    const int half = 1 << (level - 1), skip = half / kBits, rest = half % kBits;
    const int begin = std::max(changed.left - 2 * half + 1, 0) / kBits;
    for (int w = begin; w <= changed.right / kBits; ++w) {
      const auto at = [&](int i) { return i < words_ ? below[i] : ~Word{0}; };
      const Word low = at(w + skip), high = at(w + skip + 1);
      words[w] = below[w] | low >> rest | high << 1 << (kBits - 1 - rest);
    }
  }
}

/// Squares and runs reach right and up: those to the left and below see what has changed.
void Page::raise_squares(const Changed& changed) {
  const int levels = std::min(static_cast<int>(levels_.size()) - 1, kSquareLevels);
  for (int level = 0; level <= levels; ++level) {
    const int reach = 1 << level, half = reach / 2;
    const int from = std::max(0, changed.low - reach + 1);
    const int begin = std::max(0, changed.left - reach + 1) / kBits,
              end = changed.right / kBits + 1;
    for (int y = from; y <= changed.high; ++y) {
      Word* const words = line(levels_[level].squares, y);
      if (y + reach > height_) {
        std::fill(words + begin, words + end, ~Word{0});
      } else if (level == 0) {
        const Word* const row = line(levels_[0].runs, y);
        std::copy(row + begin, row + end, words + begin);
      } else {
        // The squares of half the side at the four corners.
        const Word* const low = line(levels_[level - 1].squares, y);
        const Word* const high = line(levels_[level - 1].squares, y + half);
        const int skip = half / kBits, rest = half % kBits;
        for (int w = begin; w < end; ++w) {
          const auto at = [&](int i) { return i < words_ ? low[i] | high[i] : ~Word{0}; };
          words[w] = at(w) | at(w + skip) >> rest | at(w + skip + 1) << 1 << (kBits - 1 - rest);
        }
      }
    }
    for (int b = from / kBand; b <= changed.high / kBand; ++b) {
      Word* const words = line(levels_[level].bands, b);
      std::fill(words + begin, words + end, ~Word{0});
      for (int y = b * kBand; y < std::min((b + 1) * kBand, height_); ++y) {
        const Word* const other = line(levels_[level].squares, y);
        for (int w = begin; w < end; ++w) words[w] &= other[w];
      }
    }
  }
}

int Page::skip_full_rows(const Mask& mask, int y, int last, int to, std::int64_t& steps) const {
  if (mask.squares.empty()) return y;
  const Square& square = mask.squares.front();
  const int end_word = to / kBits;
  const Word end_mask = ~Word{0} >> (kBits - 1 - to % kBits);
  while (y <= last && (y + square.y) % kBand == 0) {
    const Shifted taken(line(levels_[square.level].bands, (y + square.y) / kBand), square.x);
    for (int w = 0; w <= end_word; ++w) {
      if ((~taken[w] & (w == end_word ? end_mask : ~Word{0})) != 0) {
        steps += w + 1;
        return y;
      }
    }
    steps += end_word + 1;
    y += kBand;
  }
  return y;
}

int Page::first_free(const Mask& mask, int y, int to, std::int64_t& steps) const {
  FreePlaces free;
  for (int start = 0; start <= to / kBits; start += kMostWords) {
    free.first = 0;
    free.last = std::min(to / kBits - start, kMostWords - 1);
    std::fill_n(free.words.begin(), free.last + 1, ~Word{0});
    if (start + free.last == to / kBits) free.words[free.last] >>= kBits - 1 - to % kBits;
    for (const Square& square : mask.squares) {
      const Shifted taken(line(levels_[square.level].squares, y + square.y) + start, square.x);
      for (int w = free.first; w <= free.last; ++w) free.words[w] &= ~taken[w];
      steps += free.last - free.first + 2;
      free.narrow();
      if (free.none()) break;
    }
    for (const int probe : mask.probes) {
      if (free.none()) break;
      const Run& run = mask.runs[probe];
      const int level = log2_of(run.end - run.begin);
      const Word* const row = line(levels_[level].runs, y + run.row) + start;
      const Shifted left(row, run.begin), right(row, run.end - (1 << level));
      for (int w = free.first; w <= free.last; ++w) free.words[w] &= ~(left[w] | right[w]);
      steps += 2 * (free.last - free.first + 2);
      free.narrow();
    }
    if (!free.none()) {
      return (start + free.first) * kBits + std::countr_zero(free.words[free.first]);
    }
  }
  return -1;
}

void Page::take(const Mask& mask, int x, int y) {
  if (mask.runs.empty()) return;
  const Changed changed{x, std::min(x + mask.width, width_) - 1, y + mask.runs.front().row,
                        y + mask.runs.back().row};
  int raised = changed.low;
  for (const Run& run : mask.runs) {
    const int at = y + run.row;
    if (raised != at) raise_runs(changed, raised);
    raised = at;
    Word* const words = line(levels_[0].runs, at);
    const int begin = x + run.begin, end = x + run.end;
    for (int w = begin / kBits; w <= (end - 1) / kBits; ++w) {
      const int low = std::max(begin - w * kBits, 0), high = std::min(end - w * kBits, kBits);
      const Word bits = (high == kBits ? ~Word{0} : (Word{1} << high) - 1) & (~Word{0} << low);
      taken_ += std::popcount(bits & ~words[w]);
      words[w] |= bits;
    }
  }
  raise_runs(changed, raised);
  raise_squares(changed);
}

}  // namespace beltrami
