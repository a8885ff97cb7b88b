// The distances are those of Meijster, Roerdink & Hesselink 2000, "A general algorithm for
// computing distance transforms in linear time", with the envelope of Felzenszwalb & Huttenlocher
// 2012.
#include "atlas/page_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/interrupt.h"

namespace beltrami {
namespace {

constexpr double kFar = 1e12;  // more than the square of any distance on a page

/// Calls body(row, first column, last column) for the texels that a triangle meets, rows counted
/// from v = 0.
template <class Body>
void for_each_run(const std::array<Vec2, 3>& corners, Index side, const Body& body) {
  const auto texel = [&](double x) {
    return static_cast<Index>(std::clamp(std::floor(x), 0.0, static_cast<double>(side - 1)));
  };
  const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  const Index last_row = std::max(texel(low), texel(std::nextafter(high, low)));
  for (Index row = texel(low); row <= last_row; ++row) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (int k = 0; k < 3; ++k) {
      const Vec2 &a = corners[k], &b = corners[next_corner(k)];
      // The part of the edge within the row.
      double from = 0, to = 1;
      if (a.y() != b.y()) {
        const double s = (row - a.y()) / (b.y() - a.y()), t = (row + 1 - a.y()) / (b.y() - a.y());
        from = std::max(0.0, std::min(s, t));
        to = std::min(1.0, std::max(s, t));
      } else if (texel(a.y()) != row) {
        continue;
      }
      if (from > to) continue;
      for (const double at : {from, to}) {
        const double x = a.x() + at * (b.x() - a.x());
        left = std::min(left, x);
        right = std::max(right, x);
      }
    }
    if (left > right) continue;
    const Index first = texel(left);
    body(row, first, std::max(first, texel(std::nextafter(right, left))));
  }
}

/// Replaces values by the least of value[j] + (i - j)^2 over all j.
void spread(std::vector<double>& values) {
  const Index count = size_of(values);
  std::vector<Index> parabola(values.size());
  std::vector<double> begin(values.size() + 1);
  Index last = -1;
  for (Index j = 0; j < count; ++j) {
    if (values[j] >= kFar) continue;
    double cut = -std::numeric_limits<double>::infinity();
    while (last >= 0) {
      const Index i = parabola[last];
      cut = ((values[j] + double{1} * j * j) - (values[i] + double{1} * i * i)) / (2.0 * (j - i));
      if (cut > begin[last]) break;
      --last;
    }
    if (last < 0) cut = -std::numeric_limits<double>::infinity();
    parabola[++last] = j;
    begin[last] = cut;
  }
  if (last < 0) return;
  const std::vector<double> old = values;
  Index at = 0;
  for (Index i = 0; i < count; ++i) {
    while (at < last && begin[at + 1] < i) ++at;
    const double apart = i - parabola[at];
    values[i] = old[parabola[at]] + apart * apart;
  }
}

/// Per texel the rows to the next covered one of its column, or `most` where that is not nearer.
std::vector<std::uint16_t> rows_to_covered(const std::vector<Texel>& texels, std::size_t side,
                                           std::uint16_t most) {
  std::vector<std::uint16_t> rows(texels.size(), most);
  const auto sweep = [&](std::size_t at, std::size_t before) {
    const int next = before < texels.size() ? rows[before] + 1 : most;
    rows[at] = texels[at] == Texel::kCovered
                   ? std::uint16_t{0}
                   : static_cast<std::uint16_t>(std::min<int>(rows[at], next));
  };
  for (std::size_t at = 0; at < texels.size(); ++at) sweep(at, at - side);  // wraps: no row above
  for (std::size_t at = texels.size(); at-- > 0;) sweep(at, at + side);
  return rows;
}

/// Marks what is near a covered texel.
void add_gutters(std::vector<Texel>& texels, std::size_t side, double gutter) {
  const auto most = static_cast<std::uint16_t>(std::ceil(gutter) + 1);
  const std::vector<std::uint16_t> rows = rows_to_covered(texels, side, most);
  std::vector<double> line(side);
  for (std::size_t y = 0; y < side; ++y) {
    poll_interrupt();
    for (std::size_t x = 0; x < side; ++x) {
      const double apart = rows[y * side + x];
      line[x] = rows[y * side + x] == most ? kFar : apart * apart;
    }
    spread(line);
    for (std::size_t x = 0; x < side; ++x) {
      Texel& texel = texels[y * side + x];
      if (texel == Texel::kFree && line[x] <= gutter * gutter) texel = Texel::kGutter;
    }
  }
}

}  // namespace

std::vector<Texel> page_mask(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                             const std::vector<Index>& chart_of_face, const Pages& pages,
                             Index page) {
  const Index side = pages.resolution;
  const auto n = static_cast<std::size_t>(side);
  std::vector<Texel> texels(n * n, Texel::kFree);
  const Vec2 tile = tile_of(page);
  PollSometimes poll;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    poll();
    const Index chart = chart_of_face[f];
    if (chart == kNone || pages.page_of_chart[chart] != page) continue;
    std::array<Vec2, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = side * (uvs[faces[f][k]] - tile);
    for_each_run(corners, side, [&](Index row, Index first, Index last) {
      const auto begin = texels.begin() + (std::ptrdiff_t{side} * (side - 1 - row));
      std::fill(begin + first, begin + last + 1, Texel::kCovered);
    });
  }
  add_gutters(texels, n, pages.asked_margin);
  return texels;
}

}  // namespace beltrami
