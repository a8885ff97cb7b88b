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

/// Means of blocks of texels, smaller and smaller.
struct Means {
  int side = 0;
  std::vector<std::array<float, 4>> values;
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
        for (int column = 0; column < side_; ++column) {
          Filled& state = filled_[index(row, column)];
          if (state != Filled::kNothing) continue;
          write(row, column, between(blocks, (row + 0.5f) / kBlock, (column + 0.5f) / kBlock));
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
    for (int row = 0; row < side_; ++row) {
      poll_interrupt();
      for (int column = 0; column < side_; ++column) {
        if (filled_[index(row, column)] == Filled::kBaked) continue;
        bool beside = false;
        visit_neighbours({row, column}, [&](int y, int x) {
          beside = beside || filled_[index(y, x)] == Filled::kBaked;
        });
        if (!beside) continue;
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
      for (int x = 0; x < fine.side; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.side) +
                               static_cast<std::size_t>(x);
        if (fine.weights[at] > 0) continue;
        fine.values[at] = between(coarse, (y + 0.5f) / 2, (x + 0.5f) / 2);
        fine.weights[at] = 1;
      }
    }
  }

  /// Bilinearly between the middles of blocks.
  static std::array<float, 4> between(const Means& means, float row, float column) {
    const auto most = static_cast<float>(means.side - 1);
    const float y = std::clamp(row - 0.5f, 0.0f, most), x = std::clamp(column - 0.5f, 0.0f, most);
    const auto top = static_cast<std::size_t>(y), left = static_cast<std::size_t>(x);
    const auto side = static_cast<std::size_t>(means.side);
    const std::size_t below = std::min(top + 1, side - 1), right = std::min(left + 1, side - 1);
    const float t = y - static_cast<float>(top), s = x - static_cast<float>(left);
    std::array<float, 4> value;
    for (std::size_t k = 0; k < 4; ++k) {
      value[k] = (1 - t) * ((1 - s) * means.values[top * side + left][k] +
                            s * means.values[top * side + right][k]) +
                 t * ((1 - s) * means.values[below * side + left][k] +
                      s * means.values[below * side + right][k]);
    }
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
