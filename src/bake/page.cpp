#include "bake/page.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

using Weights = std::array<double, 3>;

/// Rows of a page that are baked at once: their sums stay in the cache of a core.
constexpr int kBandRows = 16;
/// Places along a side of a texel, where it is parted.
constexpr int kParts = 4;
constexpr std::uint16_t kAllParts = 0xFFFF;
/// Texels of the old page from one place of a new texel to the next: bilinear reading spans as
/// many, and every mean of more places would blur.
constexpr double kStep = 1.25;
/// Places up to which a texel need not be parted between triangles: the outermost of two is .6
/// texels of the old page beyond the triangle, no further than bilinear reading goes anyway.
constexpr int kFewPlaces = 2;
/// A hair outside counts as inside: rounding must not open a seam between neighbours.
constexpr double kHair = -1e-9;

/// What has been read of a texel.
struct Gathered {
  TexelSums sums{};
  float count = 0;          ///< places that were read
  std::uint16_t taken = 0;  ///< places that a triangle is at
  bool settled = false;     ///< the rest is not asked for
};

/// The corners' weights as functions of a place on the page, rows from the top.
struct Slopes {
  std::array<std::array<double, 3>, 3> of{};  ///< x, y, constant

  double at(std::size_t k, double x, double y) const {
    return of[k][0] * x + of[k][1] * y + of[k][2];
  }
  Weights weights(double x, double y) const { return {at(0, x, y), at(1, x, y), at(2, x, y)}; }
};

bool is_inside(const Weights& w) {
  return w[0] >= kHair && w[1] >= kHair && w[2] >= kHair;
}

/// How densely a triangle is read.
struct Density {
  int columns = 1, rows = 1;  ///< of places in a texel within it
  int level = 0;              ///< of the texture for these
  int level_of_parts = 0;
  bool few() const { return std::max(columns, rows) <= kFewPlaces; }
};

/// What the texels of some rows gather, and what was found last.
struct Band {
  std::vector<Gathered>& texels;
  std::size_t& hint;
};

/// A triangle that is ready to be drawn.
struct Placed {
  std::size_t number = 0;
  std::array<std::array<double, 2>, 3> corners{};  ///< rows from the top
  Slopes slopes;
  Density density;
  /// The place on the old page as a function of that on the new one, like slopes.
  std::array<double, 3> u{}, v{};
};

/// The base 2 logarithm of `x` above 1, rounded up.
int ceil_log2(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return mantissa > 0.5 ? exponent : exponent - 1;
}

int level_for(double texels) {
  return texels > kStep ? ceil_log2(std::min(texels, 1e9)) : 0;
}

class Baker {
 public:
  Baker(const PageBake& job, const PageRoom& room, std::span<Filled> filled, const Work& work)
      : job_(job), room_(room), filled_(filled), side_(job.side) {
    sort_into_bands();
    std::vector<int> most(static_cast<std::size_t>(side_ > 0 ? chunks() : 0), 0);
    parallel_for(work, count(), kTriangles, [&](std::int64_t begin, std::int64_t end) {
      int& own = most[static_cast<std::size_t>(begin / kTriangles)];
      for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
        if (const std::optional<Placed> placed = place(t)) {
          own = std::max({own, placed->density.level, placed->density.level_of_parts});
        }
      }
    });
    const int levels = most.empty() ? 0 : *std::max_element(most.begin(), most.end());
    for (Texture& page : job_.pages) page.make_levels(levels, work);
  }

  BakedTexels run(const Work& work) {
    std::fill(filled_.begin(), filled_.end(), Filled::kNothing);
    const auto all = static_cast<std::int64_t>(bands());
    // Some bands at a time, so that progress is told in between.
    const std::int64_t at_once = std::max<std::int64_t>(2 * work.threads(), kBandsAtOnce);
    for (std::int64_t first = 0; first < all; first += at_once) {
      parallel_for(work, std::min(at_once, all - first), 1,
                   [&](std::int64_t begin, std::int64_t end) {
                     std::vector<Gathered> texels(static_cast<std::size_t>(side_) * kBandRows);
                     for (std::int64_t band = first + begin; band < first + end; ++band) {
                       bake_band(static_cast<std::size_t>(band), texels);
                     }
                   });
      work.report(double(first) / double(all));
    }
    BakedTexels sum;
    for (const BakedTexels& of_band : counts_) {
      sum.covered += of_band.covered;
      sum.without_source += of_band.without_source;
    }
    return sum;
  }

 private:
  static constexpr std::int64_t kTriangles = 4096, kBandsAtOnce = 4;

  std::int64_t count() const { return static_cast<std::int64_t>(job_.triangles.size()); }
  std::int64_t chunks() const { return (count() + kTriangles - 1) / kTriangles; }
  std::size_t bands() const { return static_cast<std::size_t>((side_ - 1) / kBandRows + 1); }

  /// Those that a triangle is in; an empty range where it is beside the page.
  std::pair<int, int> bands_of(const UvTriangle& t) const {
    const double low = side_ - std::max({t[0][1], t[1][1], t[2][1]});
    const double high = side_ - std::min({t[0][1], t[1][1], t[2][1]});
    if (!(high >= 0 && low < side_)) return {0, 0};
    return {static_cast<int>(std::max(low, 0.0)) / kBandRows,
            static_cast<int>(std::min(high, side_ - 1.0)) / kBandRows + 1};
  }

  void sort_into_bands() {
    PollSometimes poll;
    first_.assign(bands() + 1, 0);
    for (const UvTriangle& triangle : job_.triangles) {
      poll();
      const auto [begin, end] = bands_of(triangle);
      for (int band = begin; band < end; ++band) ++first_[static_cast<std::size_t>(band) + 1];
    }
    for (std::size_t band = 0; band < bands(); ++band) first_[band + 1] += first_[band];
    in_bands_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < job_.triangles.size(); ++t) {
      poll();
      const auto [begin, end] = bands_of(job_.triangles[t]);
      for (int band = begin; band < end; ++band) {
        in_bands_[next[static_cast<std::size_t>(band)]++] = static_cast<std::uint32_t>(t);
      }
    }
    counts_.resize(bands());
  }

  void bake_band(std::size_t band, std::vector<Gathered>& texels) {
    const int begin = static_cast<int>(band) * kBandRows, end = std::min(begin + kBandRows, side_);
    std::fill(texels.begin(), texels.end(), Gathered{});
    std::size_t hint = 0;  // neighbours are near one another
    for (const bool parts : {false, true}) {
      for (std::size_t i = first_[band]; i < first_[band + 1]; ++i) {
        if (const std::optional<Placed> placed = place(in_bands_[i])) {
          draw(*placed, begin, end, parts, {texels, hint});
        }
      }
    }
    write_band(band, begin, end, texels);
  }

  /// Nothing for a triangle without area, in the plane or on the page.
  std::optional<Placed> place(std::size_t number) const {
    Placed placed;
    placed.number = number;
    auto& [a, b, c] = placed.corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corner = job_.triangles[number][k];
      placed.corners[k] = {corner[0], side_ - corner[1]};
    }
    const double twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (!(std::abs(twice_area) > 0)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = placed.corners[(k + 1) % 3];
      const auto& q = placed.corners[(k + 2) % 3];
      placed.slopes.of[k] = {(p[1] - q[1]) / twice_area, (q[0] - p[0]) / twice_area,
                             (p[0] * q[1] - p[1] * q[0]) / twice_area};
    }
    if (job_.sources.empty()) return placed;
    placed.density = density(number, placed.slopes);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [u, v] = job_.sources[number].uvs[k];
      for (std::size_t i = 0; i < 3; ++i) {
        placed.u[i] += placed.slopes.of[k][i] * u;
        placed.v[i] += placed.slopes.of[k][i] * v;
      }
    }
    return placed;
  }

  Density density(std::size_t number, const Slopes& slopes) const {
    const SourceTriangle& source = job_.sources[number];
    if (source.page == kNoPage) return {};
    if (job_.reading.nearest) return {kParts, kParts, 0, 0};
    const Texture& page = job_.pages[source.page];
    std::array<double, 2> texels{};  // of the old page along the axes of a new texel
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double u = 0, v = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        u += slopes.of[k][axis] * source.uvs[k][0] * page.width();
        v += slopes.of[k][axis] * source.uvs[k][1] * page.height();
      }
      texels[axis] = std::sqrt(u * u + v * v);
    }
    const auto places = [](double along) {
      return along <= kStep ? 1
                            : static_cast<int>(std::min<double>(std::ceil(along / kStep), kParts));
    };
    const double most = std::max(texels[0], texels[1]);
    const int level = level_for(most / kParts);
    return {places(texels[0]), places(texels[1]), most <= kStep * kParts ? 0 : level, level};
  }

  /// Columns of a row that a triangle may have a point in.
  std::pair<int, int> columns(const Placed& placed, int row) const {
    double low = side_, high = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = placed.corners[k];
      const auto& q = placed.corners[(k + 1) % 3];
      double from = 0, to = 1;
      const double dy = q[1] - p[1];
      if (std::abs(dy) > 0) {
        const double at_top = (row - p[1]) / dy, at_bottom = (row + 1 - p[1]) / dy;
        from = std::max(from, std::min(at_top, at_bottom));
        to = std::min(to, std::max(at_top, at_bottom));
      } else if (p[1] < row || p[1] > row + 1) {
        continue;
      }
      if (from > to) continue;
      for (const double t : {from, to}) {
        const double x = p[0] + t * (q[0] - p[0]);
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    // A centre on an edge is in the triangle, whatever rounding makes of the edge.
    constexpr double kNear = 1e-6;
    return {static_cast<int>(std::max(std::floor(low - kNear), 0.0)),
            static_cast<int>(std::min(std::floor(high + kNear) + 1, double(side_)))};
  }

  /// What is within a triangle, or else the `parts` of texels that are.
  void draw(const Placed& placed, int begin, int end, bool parts, const Band& band) const {
    const auto& [a, b, c] = placed.corners;
    const double top = std::min({a[1], b[1], c[1]}), bottom = std::max({a[1], b[1], c[1]});
    const int first = std::max(begin, static_cast<int>(std::max(std::floor(top), -1.0)));
    const int last = static_cast<int>(std::min<double>(end - 1, std::floor(bottom)));
    for (int row = first; row <= last; ++row) {
      poll_interrupt();
      const auto [from, to] = columns(placed, row);
      for (int column = from; column < to; ++column) {
        Gathered& texel =
            band.texels[static_cast<std::size_t>(row - begin) * static_cast<std::size_t>(side_) +
                        static_cast<std::size_t>(column)];
        if (texel.settled) continue;
        if (parts) {
          add_parts(placed, column, row, texel, band.hint);
        } else {
          settle(placed, column, row, texel, band.hint);
        }
      }
    }
  }

  void settle(const Placed& placed, int column, int row, Gathered& texel, std::size_t& hint) const {
    const double x = column + 0.5, y = row + 0.5;
    const Weights centre = placed.slopes.weights(x, y);
    if (!is_inside(centre)) return;
    const Density& density = placed.density;
    const std::uint8_t seams = job_.seams.empty() ? 0 : job_.seams[placed.number];
    for (std::size_t k = 0; k < 3; ++k) {
      if (density.few() && (seams >> k & 1) == 0) continue;
      const auto& slope = placed.slopes.of[k];
      if (centre[k] < (std::abs(slope[0]) + std::abs(slope[1])) / 2) return;
    }
    if (density.columns * density.rows == 1) {
      texel.settled = true;
      return read(placed, x, y, 0, texel, hint);
    }
    texel.settled = true;
    for (int j = 0; j < density.rows; ++j) {
      for (int i = 0; i < density.columns; ++i) {
        read(placed, column + (i + 0.5) / density.columns, row + (j + 0.5) / density.rows,
             density.level, texel, hint);
      }
    }
  }

  void add_parts(const Placed& placed, int column, int row, Gathered& texel,
                 std::size_t& hint) const {
    for (int part = 0; part < kParts * kParts && texel.taken != kAllParts; ++part) {
      const auto bit = static_cast<std::uint16_t>(1u << part);
      if ((texel.taken & bit) != 0) continue;
      const double x = column + (part % kParts + 0.5) / kParts;
      const auto part_row = part / kParts;
      const double y = row + (static_cast<double>(part_row) + 0.5) / kParts;
      const Weights weights = placed.slopes.weights(x, y);
      if (!is_inside(weights)) continue;
      texel.taken = static_cast<std::uint16_t>(texel.taken | bit);
      read(placed, x, y, placed.density.level_of_parts, texel, hint);
    }
  }

  /// What is shown at a place of the page, within the triangle.
  void read(const Placed& placed, double x, double y, int level, Gathered& texel,
            std::size_t& hint) const {
    TexelSource source;
    if (job_.source_of) {
      const std::optional<TexelSource> found =
          job_.source_of(placed.number, placed.slopes.weights(x, y), hint);
      if (!found) return;
      source = *found;
    } else {
      source.page = job_.sources[placed.number].page;
      if (source.page == kNoPage) return;
      source.u = placed.u[0] * x + placed.u[1] * y + placed.u[2];
      source.v = placed.v[0] * x + placed.v[1] * y + placed.v[2];
    }
    texel.count += 1;
    const Texture& page = job_.pages[source.page];
    if (job_.turns.empty()) {
      return page.add(source.u, source.v, job_.reading, level, texel.sums);
    }
    TexelSums sums{};
    page.add(source.u, source.v, job_.reading, level, sums);
    turn(job_.turns[placed.number], placed.slopes.weights(x, y), page.zero(), sums);
    for (std::size_t k = 0; k < sums.size(); ++k) texel.sums[k] += sums[k];
  }

  static void turn(const AxesTurn& turn, const Weights& weights, double zero, TexelSums& sums) {
    double cosine = 0, sine = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      cosine += weights[k] * turn.corners[k][0];
      sine += weights[k] * turn.corners[k][1];
    }
    const double length = std::sqrt(cosine * cosine + sine * sine);
    if (!(length > 0)) return;
    const double x = sums[0] - zero, y = turn.old_side * (sums[1] - zero);
    sums[0] = static_cast<float>((cosine * x - sine * y) / length + zero);
    sums[1] = static_cast<float>(turn.new_side * (sine * x + cosine * y) / length + zero);
  }

  void write_band(std::size_t band, int begin, int end, const std::vector<Gathered>& texels) {
    const auto side = static_cast<std::size_t>(side_);
    const std::size_t step = static_cast<std::size_t>(room_.components) * bytes_of(room_.type);
    for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end); ++row) {
      unsigned char* out = room_.pixels + row * room_.row_bytes;
      std::memset(out, 0, side * step);
      const Gathered* in = &texels[(row - static_cast<std::size_t>(begin)) * side];
      for (std::size_t i = 0; i < side; ++i) {
        const Gathered& texel = in[i];
        if (!texel.settled && texel.taken == 0) continue;
        ++counts_[band].covered;
        if (texel.count > 0) {
          filled_[row * side + i] = Filled::kBaked;
          job_.pages.front().finish(texel.sums, texel.count, out + step * i);
        } else {
          ++counts_[band].without_source;
        }
      }
    }
  }

  const PageBake& job_;
  const PageRoom& room_;
  std::span<Filled> filled_;
  int side_;
  std::vector<std::size_t> first_;       ///< of each band in in_bands_
  std::vector<std::uint32_t> in_bands_;  ///< triangles of each band, one band after another
  std::vector<BakedTexels> counts_;      ///< of each band
};

}  // namespace

BakedTexels bake_page(const PageBake& job, const PageRoom& room, std::span<Filled> filled,
                      const Work& work) {
  Baker baker(job, room, filled, work.part(0, 0));
  return baker.run(work);
}

}  // namespace beltrami
