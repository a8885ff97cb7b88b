#include "pack/mask.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/types.h"
#include "pack/types.h"

namespace beltrami {
namespace {

using Word = std::uint64_t;
constexpr int kBits = 64;

/// Rows of bits.
class Bits {
 public:
  Bits(int width, int height)
      : width_(width),
        height_(height),
        words_((width + kBits - 1) / kBits),
        bits_(static_cast<std::size_t>(words_) * height, 0) {}

  int width() const { return width_; }
  int height() const { return height_; }

  /// Sets the cells of a row from that of x = first to that of x = last, as far as there are such.
  void set(int row, double first, double last) {
    if (row < 0 || row >= height_ || last < 0 || first >= width_ || last < first) return;
    const int begin = static_cast<int>(std::max(first, 0.0));
    const int end = static_cast<int>(std::min<double>(last, width_ - 1)) + 1;
    Word* const words = bits_.data() + static_cast<std::size_t>(row) * words_;
    for (int w = begin / kBits; w <= (end - 1) / kBits; ++w) {
      const int low = std::max(begin - w * kBits, 0), high = std::min(end - w * kBits, kBits);
      words[w] |= (high == kBits ? ~Word{0} : (Word{1} << high) - 1) & (~Word{0} << low);
    }
  }

  /// 64 cells of a row, from the word `w` of it; none beyond.
  Word word(int row, int w) const {
    return row < height_ ? bits_[static_cast<std::size_t>(row) * words_ + w] : 0;
  }
  void set_word(int row, int w, Word word) {
    if (row < height_) bits_[static_cast<std::size_t>(row) * words_ + w] = word;
  }

  /// The next cell of a row from `from` on that is set, or not; the width where there is none.
  int next(int row, int from, bool value) const {
    const Word* const words = bits_.data() + static_cast<std::size_t>(row) * words_;
    for (int w = from / kBits; w < words_; ++w) {
      Word word = value ? words[w] : ~words[w];
      if (w == from / kBits) word &= ~Word{0} << from % kBits;
      if (word != 0) return std::min(width_, w * kBits + std::countr_zero(word));
    }
    return width_;
  }

 private:
  int width_, height_, words_;
  std::vector<Word> bits_;
};

/// The least whole number that is not below a number of cells.
int ceiling(double x) {
  const int towards_zero = static_cast<int>(x);
  return towards_zero + (x > towards_zero ? 1 : 0);
}

/// The x that a convex set covers within a band of y.
struct Extent {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

void add_disk(const Vec2& centre, double radius, double bottom, double top, Extent& extent) {
  const double rise = std::clamp(centre.y(), bottom, top) - centre.y();
  const double rest = radius * radius - rise * rise;
  if (rest < 0) return;
  const double reach = std::sqrt(rest);
  extent.add(centre.x() - reach);
  extent.add(centre.x() + reach);
}

void add_segment(const Vec2& p, const Vec2& q, double bottom, double top, Extent& extent) {
  const Vec2& low = p.y() <= q.y() ? p : q;
  const Vec2& high = p.y() <= q.y() ? q : p;
  if (low.y() > top || high.y() < bottom) return;
  const double rise = high.y() - low.y();
  const auto at = [&](double y) {
    const double share = rise > 0 ? std::clamp((y - low.y()) / rise, 0.0, 1.0) : 0.0;
    return low.x() + share * (high.x() - low.x());
  };
  extent.add(low.y() >= bottom ? low.x() : at(bottom));
  extent.add(high.y() <= top ? high.x() : at(top));
}

/// Sets the cells that meet the points within `radius` of a segment.
void draw_edge(const Vec2& p, const Vec2& q, double radius, Bits& bits) {
  const Vec2 along = q - p;
  const double length = along.norm();
  const Vec2 side =
      length > 0 ? Vec2(-along.y() * (radius / length), along.x() * (radius / length)) : Vec2(0, 0);
  const double lowest = std::min(p.y(), q.y()) - radius, highest = std::max(p.y(), q.y()) + radius;
  if (highest < 0) return;
  const int first = static_cast<int>(std::max(0.0, lowest));
  const int last = static_cast<int>(std::min<double>(bits.height() - 1, highest));
  for (int row = first; row <= last; ++row) {
    Extent extent;
    const double bottom = row, top = row + 1.0;
    add_disk(p, radius, bottom, top, extent);
    add_disk(q, radius, bottom, top, extent);
    add_segment(p + side, q + side, bottom, top, extent);
    add_segment(p - side, q - side, bottom, top, extent);
    bits.set(row, extent.low, extent.high);
  }
}

/// Sets the cells whose centres are inside.
void fill(const std::vector<Vec2>& points, const std::vector<std::array<Index, 2>>& edges,
          Bits& bits) {
  struct Crossing {
    double x;
    int turn;
  };
  std::vector<std::size_t> start(static_cast<std::size_t>(bits.height()) + 2, 0);
  const auto for_each_row = [&](const auto& visit) {
    for (const auto& [from, to] : edges) {
      const Vec2 &p = points[from], &q = points[to];
      // Rows whose centre is in [low, high).
      const int first = std::max(0, ceiling(std::min(p.y(), q.y()) - 0.5));
      const int last = std::min(bits.height(), ceiling(std::max(p.y(), q.y()) - 0.5));
      for (int row = first; row < last; ++row) visit(row, p, q);
    }
  };
  for_each_row([&](int row, const Vec2&, const Vec2&) { ++start[row + 2]; });
  for (std::size_t row = 2; row < start.size(); ++row) start[row] += start[row - 1];
  std::vector<Crossing> crossings(start.back());
  for_each_row([&](int row, const Vec2& p, const Vec2& q) {
    const double share = (row + 0.5 - p.y()) / (q.y() - p.y());
    crossings[start[row + 1]++] = {p.x() + share * (q.x() - p.x()), q.y() > p.y() ? -1 : 1};
  });
  for (int row = 0; row < bits.height(); ++row) {
    Crossing* const of_row = crossings.data() + start[row];
    const std::size_t count = start[row + 1] - start[row];
    std::sort(of_row, of_row + count,
              [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    int winding = 0;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      winding += of_row[i].turn;
      if (winding == 0) continue;
      bits.set(row, ceiling(of_row[i].x - 0.5), of_row[i + 1].x - 0.5);
    }
  }
}

/// Visits the numbers below `count` in the sequence of van der Corput, by their bits reversed.
template <class Visit>
void for_each_spread(int count, const Visit& visit) {
  unsigned top = 1;
  while (top < static_cast<unsigned>(count)) top *= 2;
  unsigned reversed = 0;
  for (unsigned i = 0; i < top; ++i) {
    if (reversed < static_cast<unsigned>(count)) visit(static_cast<int>(reversed));
    // One is added to the number that is read from right to left.
    unsigned bit = top / 2;
    for (; (reversed & bit) != 0; bit /= 2) reversed ^= bit;
    reversed |= bit;
  }
}

/// The longest run first; then rows far from those before them, where the next obstacle may be.
/// Longer runs of a row come first.
void find_probes(Mask& mask) {
  const auto length = [&](int r) { return mask.runs[r].end - mask.runs[r].begin; };
  const int count = static_cast<int>(mask.runs.size());
  if (count == 0) return;
  std::vector<int> start(static_cast<std::size_t>(mask.height) + 1, 0);
  int longest = 0;
  for (int r = 0; r < count; ++r) {
    ++start[mask.runs[r].row + 1];
    if (length(r) > length(longest)) longest = r;
  }
  for (int row = 0; row < mask.height; ++row) start[row + 1] += start[row];
  mask.probes.reserve(mask.runs.size());
  const auto add = [&](int r) {
    const Run& run = mask.runs[r];
    const int level = static_cast<int>(std::bit_width(static_cast<unsigned>(length(r)))) - 1;
    mask.probes.push_back({run.row, run.begin, run.end - (1 << level), level});
  };
  add(longest);
  mask.needs.run_level = mask.probes.front().level;
  std::vector<int> of_row;
  for_each_spread(mask.height, [&](int row) {
    if (start[row + 1] - start[row] == 1) {
      if (start[row] != longest) add(start[row]);
      return;
    }
    of_row.clear();
    for (int r = start[row]; r < start[row + 1]; ++r) {
      if (r != longest) of_row.push_back(r);
    }
    std::sort(of_row.begin(), of_row.end(),
              [&](int a, int b) { return length(a) != length(b) ? length(a) > length(b) : a < b; });
    for (const int r : of_row) add(r);
  });
}

constexpr int kSquareSamples = 48;  // per side of a mask, in the search for its largest square

/// Four squares that cover the largest square of cells, to within a sample, that the mask takes.
std::vector<Square> squares_of(const Mask& mask) {
  const int step = (std::max(mask.width, mask.height) + kSquareSamples - 1) / kSquareSamples;
  const int columns = mask.width / step, rows = mask.height / step;
  if (columns == 0 || rows == 0) return {};
  // Per sample, of step^2 cells, the rows of it that are taken from side to side.
  std::vector<int> full(static_cast<std::size_t>(columns) * rows, 0);
  for (const Run& run : mask.runs) {
    if (run.row / step >= rows) break;
    int* const line = full.data() + static_cast<std::size_t>(run.row / step) * columns;
    const int end = std::min(run.end / step, columns);
    for (int x = (run.begin + step - 1) / step; x < end; ++x) ++line[x];
  }
  // The side of the largest square whose upper right sample this is.
  std::vector<int> side(full.size(), 0);
  int best = 0, best_x = 0, best_y = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const std::size_t here = static_cast<std::size_t>(y) * columns + x;
      if (full[here] < step) continue;
      side[here] = 1;
      if (x > 0 && y > 0) {
        side[here] += std::min({side[here - 1], side[here - columns], side[here - columns - 1]});
      }
      if (side[here] > best) {
        best = side[here];
        best_x = x + 1 - best;
        best_y = y + 1 - best;
      }
    }
  }
  if (best == 0) return {};
  const int cells = best * step;
  const int level =
      std::min(static_cast<int>(std::bit_width(static_cast<unsigned>(cells))) - 1, kSquareLevels);
  const int x = best_x * step, y = best_y * step, rest = cells - (1 << level);
  std::vector<Square> squares{{x, y, level}};
  if (rest > 0) {
    squares.push_back({x + rest, y + rest, level});
    squares.push_back({x + rest, y, level});
    squares.push_back({x, y + rest, level});
  }
  return squares;
}

void read_runs(const Bits& bits, Mask& mask) {
  for (int row = 0; row < bits.height(); ++row) {
    for (int begin = bits.next(row, 0, true); begin < bits.width();) {
      const int end = bits.next(row, begin, false);
      mask.runs.push_back({row, begin, end});
      mask.cells += end - begin;
      if (end >= bits.width()) break;
      begin = bits.next(row, end, true);
    }
  }
}

/// Rows become columns (Warren, "Hacker's Delight", 7-3): bit j of word i that of i of j.
void transpose(std::array<Word, kBits>& block) {
  Word mask = 0x00000000ffffffff;
  for (int half = kBits / 2; half > 0; half /= 2, mask ^= mask << half) {
    for (int i = 0; i < kBits; i = (i + half + 1) & ~half) {
      const Word swapped = (block[i] >> half ^ block[i + half]) & mask;
      block[i] ^= swapped << half;
      block[i + half] ^= swapped;
    }
  }
}

/// Column x of the bits from below is row x of the result.
Bits transposed(const Bits& bits) {
  Bits result(bits.height(), bits.width());
  std::array<Word, kBits> block;
  for (int y = 0; y < bits.height(); y += kBits) {
    for (int x = 0; x < bits.width(); x += kBits) {
      for (int k = 0; k < kBits; ++k) block[k] = bits.word(y + k, x / kBits);
      transpose(block);
      for (int k = 0; k < kBits; ++k) result.set_word(x + k, y / kBits, block[k]);
    }
  }
  return result;
}

/// The runs of mirrored rows.
void mirror_runs(Mask& mask) {
  std::vector<Run> runs;
  runs.reserve(mask.runs.size());
  for (std::size_t first = 0, end = 0; first < mask.runs.size(); first = end) {
    const int row = mask.runs[first].row;
    while (end < mask.runs.size() && mask.runs[end].row == row) ++end;
    for (std::size_t r = end; r-- > first;) {
      runs.push_back({row, mask.width - mask.runs[r].end, mask.width - mask.runs[r].begin});
    }
  }
  mask.runs = std::move(runs);
}

std::vector<Vec2> turned(const std::vector<Vec2>& points, const Vec2& turn, double density) {
  const Placement placement{0, turn, Vec2::Zero()};
  std::vector<Vec2> places;
  places.reserve(points.size());
  for (const Vec2& p : points) places.push_back(placement.place(p, density));
  return places;
}

Mask draw(std::vector<Vec2> places, const Outline& outline, double radius, const Vec2& origin,
          int width, int height) {
  for (Vec2& p : places) p += origin;
  Bits bits(width, height);
  for (const auto& [from, to] : outline.edges) draw_edge(places[from], places[to], radius, bits);
  fill(places, outline.edges, bits);
  Mask mask;
  mask.width = width;
  mask.height = height;
  mask.origin = origin;
  read_runs(bits, mask);
  return mask;
}

/// What sums and products of places may be off by, to the places: far above their rounding.
constexpr double kRounding = 1e-12;

}  // namespace

Mask mask_of(const Outline& outline, const Vec2& turn, double density, double radius, int most) {
  std::vector<Vec2> places = turned(outline.points, turn, density);
  Eigen::AlignedBox2d box;
  for (const Vec2& p : places) box.extend(p);
  if (box.isEmpty()) return {};
  const double slack =
      kRounding * (1 + box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff());
  const double reach = radius + slack;
  const Vec2 origin = Vec2::Constant(reach + slack) - box.min();
  const Vec2 extent = box.max() + origin + Vec2::Constant(reach);
  if (!(extent.maxCoeff() < most)) {
    Mask large;
    large.width = large.height = most + 1;
    large.cells = static_cast<std::int64_t>(most) * most;
    return large;
  }
  Mask mask =
      draw(std::move(places), outline, reach, origin, static_cast<int>(std::floor(extent.x())) + 1,
           static_cast<int>(std::floor(extent.y())) + 1);
  find_probes(mask);
  mask.squares = squares_of(mask);
  if (!mask.squares.empty()) mask.needs.square_level = mask.squares.front().level;
  return mask;
}

Mask quarter_turned(const Mask& mask) {
  Mask turned;
  turned.width = mask.height;
  turned.height = mask.width;
  turned.cells = mask.cells;
  turned.origin = {mask.height - mask.origin.y(), mask.origin.x()};
  if (mask.runs.empty()) return turned;  // too large a one
  Bits bits(mask.width, mask.height);
  for (const Run& run : mask.runs) bits.set(run.row, run.begin, run.end - 1);
  turned.cells = 0;
  read_runs(transposed(bits), turned);
  mirror_runs(turned);
  find_probes(turned);
  turned.needs.square_level = mask.needs.square_level;
  for (const Square& square : mask.squares) {
    turned.squares.push_back(
        {mask.height - square.y - (1 << square.level), square.x, square.level});
  }
  return turned;
}

Mask half_turned(const Mask& mask) {
  Mask turned = mask;
  turned.origin = Vec2(mask.width, mask.height) - mask.origin;
  std::reverse(turned.runs.begin(), turned.runs.end());
  for (Run& run : turned.runs) {
    run = {mask.height - 1 - run.row, mask.width - run.end, mask.width - run.begin};
  }
  for (Probe& probe : turned.probes) {
    const int beyond = mask.width - (1 << probe.level);
    probe = {mask.height - 1 - probe.row, beyond - probe.right, beyond - probe.left, probe.level};
  }
  for (Square& square : turned.squares) {
    const int side = 1 << square.level;
    square = {mask.width - square.x - side, mask.height - square.y - side, square.level};
  }
  return turned;
}

Mask mask_at(const Outline& outline, const Vec2& turn, double density, double radius,
             const Vec2& origin, int cells) {
  return draw(turned(outline.points, turn, density), outline, radius, origin, cells, cells);
}

}  // namespace beltrami
