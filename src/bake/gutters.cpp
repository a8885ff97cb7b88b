#include "bake/gutters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "bake/image.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

/// Rings of a whole page. What is further off is only seen in images that were made smaller.
constexpr int kRingsOfWholePage = 4;
/// Texels to the side of a block, of which what is further off is a mean.
constexpr int kBlock = 4;
constexpr std::int64_t kRows = 16;

/// In the next ring, or beside the one that fills.
constexpr auto kNext = static_cast<Filled>(3);

using Values = std::vector<std::array<float, 4>>;

/// Means of blocks of texels, smaller and smaller.
struct Means {
  int side = 0;
  Values values;
  std::vector<float> weights;  ///< 0 where there is nothing yet
};

/// The gutters of a page of numbers of a type.
template <class Number>
class Gutters {
 public:
  Gutters(const PageRoom& room, std::span<Filled> filled)
      : room_(room),
        filled_(filled),
        side_(room.side),
        components_(static_cast<std::size_t>(room.components)) {}

  void fill_rings(int rings) {
    std::vector<Spot> ring = first_ring();
    for (int round = 0; round < rings && !ring.empty(); ++round) {
      PollSometimes poll;
      for (const Spot& texel : ring) {
        poll();
        take_mean(texel);
      }
      for (const auto& [row, column] : ring) filled_[index(row, column)] = Filled::kGutter;
      std::vector<Spot> next;
      for (const Spot& texel : ring) {
        poll();
        add_neighbours(texel, next);
      }
      ring = std::move(next);
    }
    for (const auto& [row, column] : ring) filled_[index(row, column)] = Filled::kNothing;
  }

  void fill_rest(const Work& work) {
    std::vector<Means> levels = {means_of_blocks(work)};
    while (levels.back().side > 1) levels.push_back(half_of(levels.back()));
    if (!(levels.back().weights.front() > 0)) return;  // there is nothing
    for (std::size_t level = levels.size() - 1; level-- > 0;) {
      fill_from(levels[level + 1], levels[level]);
    }
    const Means& blocks = levels.front();
    parallel_for(work, side_, kRows, [&](std::int64_t begin, std::int64_t end) {
      for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
        const Values line = line_between(blocks, (row + 0.5f) / kBlock);
        for (int column = 0; column < side_; ++column) {
          Filled& state = filled_[index(row, column)];
          if (state != Filled::kNothing) continue;
          write(row, column, between(line, (column + 0.5f) / kBlock));
          state = Filled::kGutter;
        }
      }
    });
  }

 private:
  struct Spot {
    int row, column;
  };

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(column);
  }

  unsigned char* texel_at(int row, int column) const {
    return room_.pixels + static_cast<std::size_t>(row) * room_.row_bytes +
           static_cast<std::size_t>(column) * components_ * sizeof(Number);
  }

  float read(int row, int column, std::size_t k) const {
    Number number;
    std::memcpy(&number, texel_at(row, column) + k * sizeof number, sizeof number);
    return static_cast<float>(number);
  }

  void write(int row, int column, const std::array<float, 4>& values) const {
    for (std::size_t k = 0; k < components_; ++k) {
      const auto number =
          static_cast<Number>(std::is_integral_v<Number> ? values[k] + 0.5f : values[k]);
      std::memcpy(texel_at(row, column) + k * sizeof number, &number, sizeof number);
    }
  }

  bool is_filled(int row, int column) const {
    const Filled state = filled_[index(row, column)];
    return state == Filled::kBaked || state == Filled::kGutter;
  }

  template <class Visit>
  void visit_neighbours(const Spot& texel, const Visit& visit) const {
    for (int y = std::max(texel.row - 1, 0); y <= std::min(texel.row + 1, side_ - 1); ++y) {
      for (int x = std::max(texel.column - 1, 0); x <= std::min(texel.column + 1, side_ - 1); ++x) {
        visit(y, x);
      }
    }
  }

  std::vector<Spot> first_ring() {
    std::vector<Spot> ring;
    // Of each column of three rows, whether something is baked: without branches, for most of a
    // page is far from every border.
    std::vector<std::uint8_t> baked(static_cast<std::size_t>(side_) + 2, 0);
    for (int row = 0; row < side_; ++row) {
      poll_interrupt();
      const Filled* above = &filled_[index(std::max(row - 1, 0), 0)];
      const Filled* here = &filled_[index(row, 0)];
      const Filled* below = &filled_[index(std::min(row + 1, side_ - 1), 0)];
      for (std::size_t x = 0; x < static_cast<std::size_t>(side_); ++x) {
        baked[x + 1] =
            static_cast<std::uint8_t>((above[x] == Filled::kBaked) | (here[x] == Filled::kBaked) |
                                      (below[x] == Filled::kBaked));
      }
      for (int column = 0; column < side_; ++column) {
        const auto x = static_cast<std::size_t>(column);
        if ((baked[x] | baked[x + 1] | baked[x + 2]) == 0 || here[x] == Filled::kBaked) continue;
        filled_[index(row, column)] = kNext;
        ring.push_back({row, column});
      }
    }
    return ring;
  }

  void add_neighbours(const Spot& texel, std::vector<Spot>& ring) {
    visit_neighbours(texel, [&](int row, int column) {
      Filled& state = filled_[index(row, column)];
      if (state != Filled::kNothing) return;
      state = kNext;
      ring.push_back({row, column});
    });
  }

  void take_mean(const Spot& texel) {
    float count = 0;
    std::array<float, 4> sums{};
    visit_neighbours(texel, [&](int row, int column) {
      if (!is_filled(row, column)) return;
      ++count;
      for (std::size_t k = 0; k < components_; ++k) sums[k] += read(row, column, k);
    });
    for (float& sum : sums) sum /= count;
    write(texel.row, texel.column, sums);
  }

  Means means_of_blocks(const Work& work) const {
    Means means;
    means.side = (side_ - 1) / kBlock + 1;
    const auto count = static_cast<std::size_t>(means.side) * static_cast<std::size_t>(means.side);
    means.values.assign(count, {});
    means.weights.assign(count, 0);
    parallel_for(work, means.side, kRows, [&](std::int64_t begin, std::int64_t end) {
      for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        for (int x = 0; x < means.side; ++x) add_block(y, x, means);
      }
    });
    return means;
  }

  void add_block(int y, int x, Means& means) const {
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(means.side) +
                           static_cast<std::size_t>(x);
    for (int row = kBlock * y; row < std::min(kBlock * (y + 1), side_); ++row) {
      for (int column = kBlock * x; column < std::min(kBlock * (x + 1), side_); ++column) {
        if (!is_filled(row, column)) continue;
        means.weights[at] += 1;
        for (std::size_t k = 0; k < components_; ++k) means.values[at][k] += read(row, column, k);
      }
    }
    if (!(means.weights[at] > 0)) return;
    for (float& value : means.values[at]) value /= means.weights[at];
    means.weights[at] = 1;
  }

  static Means half_of(const Means& fine) {
    Means half;
    half.side = (fine.side + 1) / 2;
    const auto side = static_cast<std::size_t>(half.side);
    half.values.assign(side * side, {});
    half.weights.assign(side * side, 0);
    for (int y = 0; y < fine.side; ++y) {
      poll_interrupt();
      for (int x = 0; x < fine.side; ++x) {
        const std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.side) +
                                 static_cast<std::size_t>(x);
        const std::size_t to =
            static_cast<std::size_t>(y / 2) * side + static_cast<std::size_t>(x / 2);
        if (!(fine.weights[from] > 0)) continue;
        half.weights[to] += 1;
        for (std::size_t k = 0; k < 4; ++k) half.values[to][k] += fine.values[from][k];
      }
    }
    for (std::size_t i = 0; i < half.weights.size(); ++i) {
      if (!(half.weights[i] > 0)) continue;
      for (float& value : half.values[i]) value /= half.weights[i];
      half.weights[i] = 1;
    }
    return half;
  }

  static void fill_from(const Means& coarse, Means& fine) {
    for (int y = 0; y < fine.side; ++y) {
      poll_interrupt();
      const Values line = line_between(coarse, (y + 0.5f) / 2);
      for (int x = 0; x < fine.side; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.side) +
                               static_cast<std::size_t>(x);
        if (fine.weights[at] > 0) continue;
        fine.values[at] = between(line, (x + 0.5f) / 2);
        fine.weights[at] = 1;
      }
    }
  }

  /// Two items around a place of a row, and how much the second of them counts.
  struct Pair {
    std::size_t first, second;
    float share;
  };
  static Pair pair_at(float place, std::size_t count) {
    const float at = std::clamp(place - 0.5f, 0.0f, static_cast<float>(count - 1));
    const auto first = static_cast<std::size_t>(static_cast<std::int32_t>(at));
    return {first, std::min(first + 1, count - 1), at - static_cast<float>(first)};
  }

  /// Linearly between the middles of blocks of two rows.
  static Values line_between(const Means& means, float row) {
    const auto side = static_cast<std::size_t>(means.side);
    const auto [top, below, share] = pair_at(row, side);
    Values line(side);
    for (std::size_t x = 0; x < side; ++x) {
      line[x] = mixed(means.values[top * side + x], means.values[below * side + x], share);
    }
    return line;
  }

  static std::array<float, 4> between(const Values& line, float column) {
    const auto [left, right, share] = pair_at(column, line.size());
    return mixed(line[left], line[right], share);
  }

  static std::array<float, 4> mixed(const std::array<float, 4>& a, const std::array<float, 4>& b,
                                    float share) {
    std::array<float, 4> value;
    for (std::size_t k = 0; k < 4; ++k) value[k] = (1 - share) * a[k] + share * b[k];
    return value;
  }

  const PageRoom& room_;
  std::span<Filled> filled_;
  int side_;
  std::size_t components_;
};

template <class Number>
void fill(const PageRoom& room, std::span<Filled> filled, int rings, const Work& work) {
  Gutters<Number> gutters(room, filled);
  gutters.fill_rings(rings == kWholePage ? kRingsOfWholePage : rings);
  if (rings == kWholePage) gutters.fill_rest(work);
}

}  // namespace

void fill_gutters(const PageRoom& room, std::span<Filled> filled, int rings, const Work& work) {
  switch (room.type) {
    case PixelType::kByte:
      return fill<std::uint8_t>(room, filled, rings, work);
    case PixelType::kShort:
      return fill<std::uint16_t>(room, filled, rings, work);
    case PixelType::kFloat:
      return fill<float>(room, filled, rings, work);
  }
}

}  // namespace beltrami
