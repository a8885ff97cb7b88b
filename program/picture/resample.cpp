#include "picture/resample.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <tuple>
#include <utility>

#include "files/point_numbers.h"
#include "process/interrupt.h"

namespace beltrami::cli {
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
  Sums sums{};
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

/// A triangle that is ready to be drawn.
struct Placed {
  std::size_t number = 0;
  std::array<std::array<double, 2>, 3> corners{};  ///< rows from the top
  Slopes slopes;
  Density density;
};

int level_for(double texels) {
  return texels > kStep ? static_cast<int>(std::ceil(std::log2(std::min(texels, 1e9)))) : 0;
}

class Baker {
 public:
  explicit Baker(const BakeJob& job) : job_(job), side_(job.side) {
    sort_into_bands();
    int most = 0;
    for (std::size_t t = 0; t < job_.triangles.size(); ++t) {
      if (const std::optional<Placed> placed = place(t)) {
        most = std::max({most, placed->density.level, placed->density.level_of_parts});
      }
    }
    for (Texture& page : job_.pages) page.make_levels(most);
  }

  Baked run() {
    const auto side = static_cast<std::size_t>(side_);
    baked_.image.width = baked_.image.height = side_;
    baked_.image.components = job_.pages.front().components();
    baked_.image.values.assign(baked_.image.row_size() * side, 0);
    baked_.filled.assign(side * side, 0);
    const int wanted = job_.source_of ? 1 : job_.threads;
    const int threads = std::clamp(wanted, 1, static_cast<int>(bands()));
    // What needs memory comes before the threads, but for the list of them itself.
    std::vector<std::vector<Gathered>> texels(static_cast<std::size_t>(threads));
    for (auto& of_thread : texels) of_thread.resize(side * kBandRows);
    std::vector<std::thread> others;
    others.reserve(texels.size());
    try {
      for (std::size_t i = 1; i < texels.size(); ++i) {
        others.emplace_back([this, &mine = texels[i]] { work(mine, false); });
      }
    } catch (const std::exception&) {
      // The system has no more of them, or no memory for more: those that there are do all.
    }
    work(texels[0], true);
    for (std::thread& other : others) other.join();
    throw_if_interrupted();
    if (failure_) std::rethrow_exception(failure_);
    for (const auto& [covered, without] : counts_) {
      baked_.covered += covered;
      baked_.without_source += without;
    }
    return std::move(baked_);
  }

 private:
  std::size_t bands() const { return static_cast<std::size_t>((side_ - 1) / kBandRows + 1); }

  /// Those that a triangle is in; an empty range where it is beside the page.
  std::pair<int, int> bands_of(const BakedTriangle& t) const {
    const double low = side_ - std::max({t[0][1], t[1][1], t[2][1]});
    const double high = side_ - std::min({t[0][1], t[1][1], t[2][1]});
    if (!(high >= 0 && low < side_)) return {0, 0};
    return {static_cast<int>(std::max(low, 0.0)) / kBandRows,
            static_cast<int>(std::min(high, side_ - 1.0)) / kBandRows + 1};
  }

  void sort_into_bands() {
    first_.assign(bands() + 1, 0);
    for (const BakedTriangle& triangle : job_.triangles) {
      const auto [begin, end] = bands_of(triangle);
      for (int band = begin; band < end; ++band) ++first_[static_cast<std::size_t>(band) + 1];
    }
    for (std::size_t band = 0; band < bands(); ++band) first_[band + 1] += first_[band];
    in_bands_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < job_.triangles.size(); ++t) {
      const auto [begin, end] = bands_of(job_.triangles[t]);
      for (int band = begin; band < end; ++band) {
        in_bands_[next[static_cast<std::size_t>(band)]++] = t;
      }
    }
    counts_.resize(bands());
  }

  /// Bakes bands as long as there are some. Throws nothing.
  void work(std::vector<Gathered>& texels, bool tells) noexcept {
    try {
      while (!interrupted()) {
        const std::size_t band = next_band_++;
        if (band >= bands()) return;
        bake_band(band, texels);
        if (tells && job_.progress) job_.progress(double(band) / double(bands()));
      }
    } catch (...) {
      if (!failed_.test_and_set()) failure_ = std::current_exception();
    }
  }

  void bake_band(std::size_t band, std::vector<Gathered>& texels) {
    const int begin = static_cast<int>(band) * kBandRows, end = std::min(begin + kBandRows, side_);
    std::fill(texels.begin(), texels.end(), Gathered{});
    for (const bool parts : {false, true}) {
      for (std::size_t i = first_[band]; i < first_[band + 1]; ++i) {
        if (const std::optional<Placed> placed = place(in_bands_[i])) {
          draw(*placed, begin, end, parts, texels);
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
    if (!job_.sources.empty()) placed.density = density(number, placed.slopes);
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
  void draw(const Placed& placed, int begin, int end, bool parts,
            std::vector<Gathered>& texels) const {
    const auto& [a, b, c] = placed.corners;
    const double top = std::min({a[1], b[1], c[1]}), bottom = std::max({a[1], b[1], c[1]});
    const int first = std::max(begin, static_cast<int>(std::max(std::floor(top), -1.0)));
    const int last = static_cast<int>(std::min<double>(end - 1, std::floor(bottom)));
    for (int row = first; row <= last; ++row) {
      const auto [from, to] = columns(placed, row);
      for (int column = from; column < to; ++column) {
        Gathered& texel =
            texels[static_cast<std::size_t>(row - begin) * static_cast<std::size_t>(side_) +
                   static_cast<std::size_t>(column)];
        if (texel.settled) continue;
        if (parts) {
          add_parts(placed, column, row, texel);
        } else {
          settle(placed, column, row, texel);
        }
      }
    }
  }

  void settle(const Placed& placed, int column, int row, Gathered& texel) const {
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
      return read(placed, centre, 0, texel);
    }
    texel.settled = true;
    for (int j = 0; j < density.rows; ++j) {
      for (int i = 0; i < density.columns; ++i) {
        read(placed,
             placed.slopes.weights(column + (i + 0.5) / density.columns,
                                   row + (j + 0.5) / density.rows),
             density.level, texel);
      }
    }
  }

  void add_parts(const Placed& placed, int column, int row, Gathered& texel) const {
    for (int part = 0; part < kParts * kParts && texel.taken != kAllParts; ++part) {
      const auto bit = static_cast<std::uint16_t>(1u << part);
      if ((texel.taken & bit) != 0) continue;
      const double x = column + (part % kParts + 0.5) / kParts;
      const auto part_row = part / kParts;
      const double y = row + (static_cast<double>(part_row) + 0.5) / kParts;
      const Weights weights = placed.slopes.weights(x, y);
      if (!is_inside(weights)) continue;
      texel.taken = static_cast<std::uint16_t>(texel.taken | bit);
      read(placed, weights, placed.density.level_of_parts, texel);
    }
  }

  void read(const Placed& placed, const Weights& weights, int level, Gathered& texel) const {
    Source source;
    if (job_.source_of) {
      const std::optional<Source> found = job_.source_of(placed.number, weights);
      if (!found) return;
      source = *found;
    } else {
      const SourceTriangle& triangle = job_.sources[placed.number];
      if (triangle.page == kNoPage) return;
      source.page = triangle.page;
      for (std::size_t k = 0; k < 3; ++k) {
        source.u += weights[k] * triangle.uvs[k][0];
        source.v += weights[k] * triangle.uvs[k][1];
      }
    }
    texel.count += 1;
    const Texture& page = job_.pages[source.page];
    if (job_.turns.empty()) {
      return page.add(source.u, source.v, job_.reading, level, texel.sums);
    }
    Sums sums{};
    page.add(source.u, source.v, job_.reading, level, sums);
    turn(job_.turns[placed.number], weights, sums);
    for (std::size_t k = 0; k < sums.size(); ++k) texel.sums[k] += sums[k];
  }

  static void turn(const AxesTurn& turn, const Weights& weights, Sums& sums) {
    double cosine = 0, sine = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      cosine += weights[k] * turn.corners[k][0];
      sine += weights[k] * turn.corners[k][1];
    }
    const double length = std::sqrt(cosine * cosine + sine * sine);
    if (!(length > 0)) return;
    const double x = sums[0] - Texture::kZero, y = turn.old_side * (sums[1] - Texture::kZero);
    sums[0] = static_cast<float>((cosine * x - sine * y) / length + Texture::kZero);
    sums[1] = static_cast<float>(turn.new_side * (sine * x + cosine * y) / length + Texture::kZero);
  }

  void write_band(std::size_t band, int begin, int end, const std::vector<Gathered>& texels) {
    const auto side = static_cast<std::size_t>(side_);
    const std::size_t offset = static_cast<std::size_t>(begin) * side;
    const auto components = static_cast<std::size_t>(baked_.image.components);
    for (std::size_t i = 0; i < static_cast<std::size_t>(end - begin) * side; ++i) {
      const Gathered& texel = texels[i];
      if (!texel.settled && texel.taken == 0) continue;
      ++counts_[band].first;
      if (texel.count > 0) {
        baked_.filled[offset + i] = 1;
        job_.pages.front().finish(texel.sums, texel.count,
                                  &baked_.image.values[components * (offset + i)]);
      } else {
        ++counts_[band].second;
      }
    }
  }

  const BakeJob& job_;
  int side_;
  Baked baked_;
  std::vector<std::size_t> first_, in_bands_;  ///< triangles of each band, one band after another
  std::vector<std::pair<std::uint64_t, std::uint64_t>> counts_;  ///< covered, without a source
  std::atomic<std::size_t> next_band_ = 0;
  std::atomic_flag failed_;
  std::exception_ptr failure_;
};

/// The gutters of a page, ring by ring.
class Gutters {
 public:
  explicit Gutters(Baked& baked)
      : image_(baked.image), filled_(baked.filled), side_(baked.image.width) {}

  void fill(int rings) {
    std::vector<Place> ring;
    for (int row = 0; row < side_; ++row) {
      for (int column = 0; column < side_; ++column) {
        if (filled_[index(row, column)] == 0 && is_beside_filled(row, column)) {
          filled_[index(row, column)] = kNext;
          ring.push_back({row, column});
        }
      }
    }
    for (int round = 0; round < rings && !ring.empty(); ++round) {
      throw_if_interrupted();
      for (const Place& texel : ring) take_mean(texel);
      for (const auto& [row, column] : ring) filled_[index(row, column)] = 1;
      std::vector<Place> next;
      for (const Place& texel : ring) add_neighbours(texel, next);
      ring = std::move(next);
    }
    for (const auto& [row, column] : ring) filled_[index(row, column)] = 0;
  }

 private:
  struct Place {
    int row, column;
  };
  /// In the next ring.
  static constexpr std::uint8_t kNext = 2;

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(column);
  }

  template <class Visit>
  void visit_neighbours(const Place& texel, const Visit& visit) const {
    for (int y = std::max(texel.row - 1, 0); y <= std::min(texel.row + 1, side_ - 1); ++y) {
      for (int x = std::max(texel.column - 1, 0); x <= std::min(texel.column + 1, side_ - 1); ++x) {
        visit(y, x);
      }
    }
  }

  bool is_beside_filled(int row, int column) const {
    bool beside = false;
    visit_neighbours({row, column},
                     [&](int y, int x) { beside = beside || filled_[index(y, x)] == 1; });
    return beside;
  }

  void add_neighbours(const Place& texel, std::vector<Place>& ring) {
    visit_neighbours(texel, [&](int row, int column) {
      std::uint8_t& state = filled_[index(row, column)];
      if (state != 0) return;
      state = kNext;
      ring.push_back({row, column});
    });
  }

  void take_mean(const Place& texel) {
    switch (image_.components) {
      case 1:
        return take_mean_of<1>(texel);
      case 2:
        return take_mean_of<2>(texel);
      case 3:
        return take_mean_of<3>(texel);
      default:
        return take_mean_of<4>(texel);
    }
  }

  template <std::size_t kComponents>
  void take_mean_of(const Place& texel) {
    int count = 0;
    std::array<int, kComponents> sums{};
    visit_neighbours(texel, [&](int row, int column) {
      const std::size_t i = index(row, column);
      if (filled_[i] != 1) return;
      ++count;
      const std::uint8_t* values = &image_.values[kComponents * i];
      for (std::size_t k = 0; k < kComponents; ++k) sums[k] += values[k];
    });
    std::uint8_t* own = &image_.values[kComponents * index(texel.row, texel.column)];
    for (std::size_t k = 0; k < kComponents; ++k) {
      own[k] = static_cast<std::uint8_t>((sums[k] + count / 2) / count);
    }
  }

  Pixels& image_;
  std::vector<std::uint8_t>& filled_;
  int side_;
};

}  // namespace

Baked bake(const BakeJob& job) {
  return Baker(job).run();
}

std::vector<std::uint8_t> inner_seams(std::span<const BakedTriangle> triangles,
                                      std::span<const SourceTriangle> sources) {
  struct Side {
    std::pair<std::uint32_t, std::uint32_t> ends;   // on the new page, the lesser first
    std::pair<std::uint32_t, std::uint32_t> shown;  // the same on the old one
    std::size_t triangle, corner;
  };
  PointNumbers<2> places, old_places;
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint32_t, 3> ends{}, shown{};
    for (std::size_t k = 0; k < 3; ++k) {
      ends[k] = places.number(triangles[t][k]);
      shown[k] = old_places.number(sources[t].uvs[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      if (ends[a] > ends[b]) std::swap(a, b);
      sides.push_back({{ends[a], ends[b]}, {shown[a], shown[b]}, t, k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.ends, a.triangle, a.corner) < std::tie(b.ends, b.triangle, b.corner);
  });
  std::vector<std::uint8_t> seams(triangles.size(), 0);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.ends != b.ends || a.shown == b.shown) continue;
    for (const Side* side : {&a, &b}) {
      seams[side->triangle] = static_cast<std::uint8_t>(seams[side->triangle] | 1u << side->corner);
    }
  }
  return seams;
}

void fill_gutters(Baked& baked, int rings) {
  Gutters(baked).fill(rings);
}

}  // namespace beltrami::cli
