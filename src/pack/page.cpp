#include "pack/page.h"

#include <algorithm>
#include <array>
#include <bit>

namespace beltrami {
namespace {

constexpr int kMostWords = 128;  // free places that are looked at together

int log2_of(int x) {
  return std::bit_width(static_cast<unsigned>(x)) - 1;
}

}  // namespace

Page::Page(int cells)
    : cells_(cells),
      words_((cells + kBits - 1) / kBits + 2),
      levels_(log2_of(cells) + 1),
      bits_(static_cast<std::size_t>(words_) * cells * levels_, 0) {
  for (int y = 0; y < cells; ++y) {
    Word* const words = row(0, y);
    for (int x = cells; x < words_ * kBits; ++x) words[x / kBits] |= Word{1} << x % kBits;
    raise_levels(y);
  }
}

void Page::raise_levels(int y) {
  for (int level = 1; level < levels_; ++level) {
    const Word* const below = row(level - 1, y);
    Word* const words = row(level, y);
    const int shift = 1 << (level - 1), skip = shift / kBits, rest = shift % kBits;
    for (int w = 0; w < words_; ++w) {
      const auto at = [&](int i) { return i < words_ ? below[i] : ~Word{0}; };
      const Word low = at(w + skip), high = at(w + skip + 1);
      words[w] = below[w] | (rest == 0 ? low : low >> rest | high << (kBits - rest));
    }
  }
}

int Page::first_free(const Mask& mask, int y, int from, int to, std::int64_t& steps) const {
  std::array<Word, kMostWords> free;
  for (int start = from / kBits; start <= to / kBits; start += kMostWords) {
    int first = start, last = std::min(to / kBits, start + kMostWords - 1);
    std::fill(free.begin(), free.begin() + (last - first + 1), ~Word{0});
    const auto at = [&](int w) -> Word& { return free[w - start]; };
    if (first == from / kBits) at(first) &= ~Word{0} << from % kBits;
    if (last == to / kBits) at(last) &= ~Word{0} >> (kBits - 1 - to % kBits);
    for (const int probe : mask.probes) {
      const Run& run = mask.runs[probe];
      const int level = log2_of(run.end - run.begin);
      const Word* const words = row(level, y + run.row);
      const int one = run.begin, other = run.end - (1 << level);
      const int skip = one / kBits, rest = one % kBits;
      const int skip2 = other / kBits, rest2 = other % kBits;
      steps += last - first + 2;
      // A shift by 64 is none: the word above is shifted by one first.
      for (int w = first; w <= last; ++w) {
        const Word a = words[w + skip] >> rest | words[w + skip + 1] << 1 << (kBits - 1 - rest);
        const Word b = words[w + skip2] >> rest2 | words[w + skip2 + 1] << 1 << (kBits - 1 - rest2);
        at(w) &= ~(a | b);
      }
      while (first <= last && at(first) == 0) ++first;
      while (last >= first && at(last) == 0) --last;
      if (first > last) break;
    }
    if (first <= last) return first * kBits + std::countr_zero(at(first));
  }
  return -1;
}

void Page::take(const Mask& mask, int x, int y) {
  int raised = -1;
  for (const Run& run : mask.runs) {
    const int line = y + run.row;
    if (raised >= 0 && raised != line) raise_levels(raised);
    raised = line;
    Word* const words = row(0, line);
    const int begin = x + run.begin, end = x + run.end;
    for (int w = begin / kBits; w <= (end - 1) / kBits; ++w) {
      const int low = std::max(begin - w * kBits, 0), high = std::min(end - w * kBits, kBits);
      const Word bits = (high == kBits ? ~Word{0} : (Word{1} << high) - 1) & (~Word{0} << low);
      taken_ += std::popcount(bits & ~words[w]);
      words[w] |= bits;
    }
  }
  if (raised >= 0) raise_levels(raised);
}

}  // namespace beltrami
