#include "bake/page.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
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
static_assert(kParts * kParts == kPartsOfTexel);
constexpr std::uint16_t kAllParts = 0xFFFF;
/// Texels of the old page from one place of a new texel to the next: bilinear reading spans as
/// many, and every mean of more places would blur.
constexpr double kStep = 1.25;
/// Places up to which a texel need not be parted between triangles: the outermost of two is .6
/// texels of the old page beyond the triangle, no further than bilinear reading goes anyway.
constexpr int kFewPlaces = 2;
/// A hair outside counts as inside: rounding must not open a seam between neighbours.
constexpr double kHair = -1e-9;

/// The outermost of the places of a texel that is parted, from its centre.
constexpr double kOutermost = 0.5 - 0.5 / kParts;
/// Texels side by side that are read at once.
constexpr int kAtOnce = 64;

/// What has been read of a texel that several triangles share.
struct Gathered {
  TexelSums sums{};
  float count = 0;          ///< places that were read
  std::uint16_t taken = 0;  ///< places that a triangle is at
  std::size_t texel = 0;    ///< of the page
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

/// A triangle that is ready to be drawn.
struct Placed {
  std::size_t number = 0;
  std::array<std::array<double, 2>, 3> corners{};  ///< rows from the top
  Slopes slopes;
  Weights per_x{};  ///< of each weight: texels in a row for which it grows by 1
  Weights inner{};  ///< weights from which on a texel belongs to the triangle alone
  Weights outer{};  ///< those from which on a place of a texel may be within it
  Density density;
  /// The place on the old page as a function of that on the new one, like slopes.
  std::array<double, 3> u{}, v{};
};

/// Columns of a row: [from, to).
struct Columns {
  int from = 0, to = 0;
};

/// Texels of a row by what is known of them; from kShared on the number of one of `shared`.
enum TexelState : std::uint32_t { kOpen = 0, kSettled = 1, kShared = 2 };

/// Some rows that are baked at once.
struct Band {
  int begin = 0, end = 0;
  std::vector<std::uint32_t> states;  ///< of each texel
  std::vector<Gathered> shared;
  std::vector<Placed> triangles;
  std::size_t hint = 0;  ///< what was found last: neighbours are near one another
  BakedTexels count;
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
                     Band band;
                     for (std::int64_t i = first + begin; i < first + end; ++i) {
                       bake_band(static_cast<std::size_t>(i), band);
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

  void bake_band(std::size_t number, Band& band) {
    band.begin = static_cast<int>(number) * kBandRows;
    band.end = std::min(band.begin + kBandRows, side_);
    band.states.assign(static_cast<std::size_t>(band.end - band.begin) * side(), kOpen);
    band.shared.clear();
    band.triangles.clear();
    band.hint = 0;
    band.count = {};
    for (int row = band.begin; row < band.end; ++row) {
      std::memset(pixel(row, 0), 0, side() * texel_bytes());
    }
    for (std::size_t i = first_[number]; i < first_[number + 1]; ++i) {
      const std::optional<Placed> placed = place(in_bands_[i]);
      if (!placed) continue;
      band.triangles.push_back(*placed);
      draw_within(*placed, band);
    }
    for (const Placed& placed : band.triangles) draw_shared(placed, band);
    finish_shared(band);
    counts_[number] = band.count;
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
    if (!job_.sources.empty()) place_source(placed);
    const std::uint8_t seams = job_.seams.empty() ? 0 : job_.seams[number];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& slope = placed.slopes.of[k];
      const double around = std::abs(slope[0]) + std::abs(slope[1]);
      const bool joined = placed.density.few() && (seams >> k & 1) == 0;
      placed.per_x[k] = 1 / slope[0];
      placed.inner[k] = joined ? kHair : std::max(kHair, around / 2);
      placed.outer[k] = kHair - kOutermost * around;
    }
    return placed;
  }

  void place_source(Placed& placed) const {
    const std::size_t number = placed.number;
    placed.density = density(number, placed.slopes);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [u, v] = job_.sources[number].uvs[k];
      for (std::size_t i = 0; i < 3; ++i) {
        placed.u[i] += placed.slopes.of[k][i] * u;
        placed.v[i] += placed.slopes.of[k][i] * v;
      }
    }
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
      const double parts = std::ceil(along / kStep);
      return along <= kStep ? 1 : parts < kParts ? static_cast<int>(parts) : kParts;
    };
    const double most = std::max(texels[0], texels[1]);
    const int level = level_for(most / kParts);
    return {places(texels[0]), places(texels[1]), most <= kStep * kParts ? 0 : level, level};
  }

  /// Those rows of a band that a triangle has a point in.
  std::pair<int, int> rows_of(const Placed& placed, const Band& band) const {
    const auto& [a, b, c] = placed.corners;
    const double top = std::min({a[1], b[1], c[1]}), bottom = std::max({a[1], b[1], c[1]});
    return {std::max(band.begin, static_cast<int>(std::max(std::floor(top), -1.0))),
            static_cast<int>(std::min<double>(band.end - 1, std::floor(bottom))) + 1};
  }

  /// Texels of a row whose centres have these weights at least, but for rounding.
  Columns columns(const Placed& placed, int row, const Weights& least) const {
    const auto& [a, b, c] = placed.corners;
    double low = std::max(std::min({a[0], b[0], c[0]}) - 1, 0.5);
    double high = std::min(std::max({a[0], b[0], c[0]}) + 1, side_ - 0.5);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& slope = placed.slopes.of[k];
      const double rest = slope[1] * (row + 0.5) + slope[2];
      const double at = (least[k] - rest) * placed.per_x[k];
      if (slope[0] > 0) low = std::max(low, at);
      if (slope[0] < 0) high = std::min(high, at);
      if (!(std::abs(slope[0]) > 0) && rest < least[k]) return {};
    }
    if (!(low <= high + 1)) return {};
    return {static_cast<int>(std::ceil(low - 0.5)), static_cast<int>(std::floor(high - 0.5)) + 1};
  }

  /// Exactly the texels of a row whose centres have these weights at least: one after another, for
  /// a weight that is rounded rises or falls along a row still.
  Columns exact_columns(const Placed& placed, int row, const Weights& least) const {
    const auto is_in = [&](int column) {
      const Weights at = placed.slopes.weights(column + 0.5, row + 0.5);
      return at[0] >= least[0] && at[1] >= least[1] && at[2] >= least[2];
    };
    auto [from, to] = columns(placed, row, least);
    from = std::max(from - 1, 0);
    to = std::min(to + 1, side_);
    while (from < to && !is_in(from)) ++from;
    while (from < to && !is_in(to - 1)) --to;
    return {from, to};
  }

  /// What belongs to a triangle alone.
  void draw_within(const Placed& placed, Band& band) const {
    const auto [begin, end] = rows_of(placed, band);
    for (int row = begin; row < end; ++row) {
      poll_interrupt();
      const auto [from, to] = exact_columns(placed, row, placed.inner);
      std::uint32_t* states = &band.states[static_cast<std::size_t>(row - band.begin) * side()];
      for (int column = from; column < to;) {
        if (states[column] != kOpen) {
          ++column;
          continue;
        }
        const int first = column, most = std::min(to, first + kAtOnce);
        while (column < most && states[column] == kOpen) states[column++] = kSettled;
        settle(placed, row, {first, column}, band);
      }
    }
  }

  /// Reads texels side by side, and writes them.
  void settle(const Placed& placed, int row, const Columns& columns, Band& band) const {
    const auto count = static_cast<std::size_t>(columns.to - columns.from);
    band.count.covered += count;
    std::array<TexelSums, kAtOnce> sums;
    std::fill_n(sums.begin(), count, TexelSums{});
    if (job_.show) return settle_each(placed, row, columns, band);
    if (job_.sources[placed.number].page == kNoPage) {
      band.count.without_source += count;
      return;
    }
    const Density& density = placed.density;
    std::array<Place, kAtOnce> places;
    for (int j = 0; j < density.rows; ++j) {
      const double y = density.rows == 1 ? row + 0.5 : row + (j + 0.5) / density.rows;
      const double u_of_y = placed.u[1] * y, v_of_y = placed.v[1] * y;
      for (int i = 0; i < density.columns; ++i) {
        const double offset = (i + 0.5) / density.columns;
        for (std::size_t k = 0; k < count; ++k) {
          const double x = columns.from + static_cast<int>(k) + offset;
          places[k] = {placed.u[0] * x + u_of_y + placed.u[2],
                       placed.v[0] * x + v_of_y + placed.v[2]};
        }
        read(placed, {places.data(), count}, {columns.from + offset, y}, density.level,
             {sums.data(), count});
      }
    }
    job_.pages.front().finish({sums.data(), count},
                              static_cast<float>(density.rows * density.columns),
                              pixel(row, columns.from));
    std::fill_n(&filled_[texel(row, columns.from)], count, Filled::kBaked);
  }

  /// The same where each texel has a source of its own.
  void settle_each(const Placed& placed, int row, const Columns& columns, Band& band) const {
    for (int column = columns.from; column < columns.to; ++column) {
      TexelSums sums{};
      const Weights weights = placed.slopes.weights(column + 0.5, row + 0.5);
      if (!job_.show(placed.number, weights, kWholeTexel, band.hint, sums)) {
        ++band.count.without_source;
        continue;
      }
      job_.pages.front().finish({&sums, 1}, 1, pixel(row, column));
      filled_[texel(row, column)] = Filled::kBaked;
    }
  }

  /// Gathers places of texels that belong to no triangle alone.
  void draw_shared(const Placed& placed, Band& band) const {
    const auto [begin, end] = rows_of(placed, band);
    for (int row = begin; row < end; ++row) {
      poll_interrupt();
      gather(placed, row, columns(placed, row, placed.outer), band);
    }
  }

  void gather(const Placed& placed, int row, const Columns& columns, Band& band) const {
    std::uint32_t* states = &band.states[static_cast<std::size_t>(row - band.begin) * side()];
    for (int column = columns.from; column < columns.to; ++column) {
      std::uint32_t& state = states[column];
      if (state == kSettled) continue;
      if (state != kOpen) {
        add_parts(placed, column, row, band.shared[state - kShared], band.hint);
        continue;
      }
      Gathered gathered;
      add_parts(placed, column, row, gathered, band.hint);
      if (gathered.taken == 0) continue;
      gathered.texel = texel(row, column);
      state = kShared + static_cast<std::uint32_t>(band.shared.size());
      band.shared.push_back(gathered);
    }
  }

  void add_parts(const Placed& placed, int column, int row, Gathered& gathered,
                 std::size_t& hint) const {
    for (int part = 0; part < kParts * kParts && gathered.taken != kAllParts; ++part) {
      const auto bit = static_cast<std::uint16_t>(1u << part);
      if ((gathered.taken & bit) != 0) continue;
      const double x = column + (part % kParts + 0.5) / kParts;
      const auto part_row = part / kParts;
      const double y = row + (static_cast<double>(part_row) + 0.5) / kParts;
      if (!is_inside(placed.slopes.weights(x, y))) continue;
      gathered.taken = static_cast<std::uint16_t>(gathered.taken | bit);
      if (read_part(placed, {x, y}, part, gathered.sums, hint)) gathered.count += 1;
    }
  }

  /// Adds what is shown at a place of the page, within the triangle, if that has a source.
  bool read_part(const Placed& placed, const std::array<double, 2>& at, int part, TexelSums& sums,
                 std::size_t& hint) const {
    const auto [x, y] = at;
    if (job_.show) {
      return job_.show(placed.number, placed.slopes.weights(x, y), part, hint, sums);
    }
    if (job_.sources[placed.number].page == kNoPage) return false;
    const Place place{placed.u[0] * x + placed.u[1] * y + placed.u[2],
                      placed.v[0] * x + placed.v[1] * y + placed.v[2]};
    read(placed, {&place, 1}, at, placed.density.level_of_parts, {&sums, 1});
    return true;
  }

  /// Adds what the old page shows at places, one texel after another from `at` on.
  void read(const Placed& placed, std::span<const Place> places, const std::array<double, 2>& at,
            int level, std::span<TexelSums> sums) const {
    const Texture& page = job_.pages[job_.sources[placed.number].page];
    if (job_.turns.empty()) return page.add(places, job_.reading, level, sums);
    std::array<TexelSums, kAtOnce> read;
    std::fill_n(read.begin(), places.size(), TexelSums{});
    page.add(places, job_.reading, level, {read.data(), places.size()});
    const AxesTurn& how = job_.turns[placed.number];
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Weights weights = placed.slopes.weights(at[0] + double(i), at[1]);
      turn(how, weights, page.zero(), read[i]);
      for (std::size_t k = 0; k < read[i].size(); ++k) sums[i][k] += read[i][k];
    }
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

  void finish_shared(Band& band) const {
    band.count.covered += band.shared.size();
    for (const Gathered& gathered : band.shared) {
      if (!(gathered.count > 0)) {
        ++band.count.without_source;
        continue;
      }
      const auto row = static_cast<int>(gathered.texel / side());
      const auto column = static_cast<int>(gathered.texel % side());
      job_.pages.front().finish({&gathered.sums, 1}, gathered.count, pixel(row, column));
      filled_[gathered.texel] = Filled::kBaked;
    }
  }

  std::size_t side() const { return static_cast<std::size_t>(side_); }
  std::size_t texel(int row, int column) const {
    return static_cast<std::size_t>(row) * side() + static_cast<std::size_t>(column);
  }
  std::size_t texel_bytes() const {
    return static_cast<std::size_t>(room_.components) * bytes_of(room_.type);
  }
  unsigned char* pixel(int row, int column) const {
    return room_.pixels + static_cast<std::size_t>(row) * room_.row_bytes +
           static_cast<std::size_t>(column) * texel_bytes();
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
