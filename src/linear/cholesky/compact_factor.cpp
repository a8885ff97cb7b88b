#include "linear/cholesky/compact_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "linear/cholesky/factor_solve.h"

namespace beltrami {
namespace {

constexpr float kLargest = std::numeric_limits<std::int16_t>::max();
/// Of a column, below which its entries are taken for zero: what they are multiplied with to get
/// whole numbers would overflow.
constexpr float kLeast = kLargest * std::numeric_limits<float>::min();
constexpr std::int64_t kGrain = 64;  // supernodes

std::int64_t entries_below_diagonal(std::int64_t height, std::int64_t width) {
  return width * height - width * (width + 1) / 2;
}

}  // namespace

CompactFactor::CompactFactor(const Symbolic& symbolic, const float* panels, const Work& work) {
  const int count = symbolic.supernode_count();
  start_.resize(static_cast<std::size_t>(count) + 1);
  for (int s = 0; s < count; ++s) {
    start_[s + 1] = start_[s] + entries_below_diagonal(symbolic.height(s), symbolic.width(s));
  }
  parallel_assign(work, entries_, static_cast<std::size_t>(start_.back()));
  const auto columns = static_cast<std::size_t>(symbolic.column_count()) *
                       static_cast<std::size_t>(symbolic.block_size);
  diagonal_.resize(columns);
  unit_.resize(columns);
  parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto s = static_cast<int>(begin); s < end; ++s) {
      const int height = symbolic.height(s), width = symbolic.width(s);
      const float* column = panels + symbolic.value_start[s];
      std::int16_t* to = entries_.data() + start_[s];
      std::int64_t at = std::int64_t{symbolic.block_size} * symbolic.first_column[s];
      for (int c = 0; c < width; ++c, ++at, column += height) {
        diagonal_[at] = column[c];
        float largest = 0;
        for (int r = c + 1; r < height; ++r) largest = std::max(largest, std::abs(column[r]));
        if (largest < kLeast) largest = 0;
        unit_[at] = largest / kLargest;
        const float inverse = largest > 0 ? kLargest / largest : 0;
        for (int r = c + 1; r < height; ++r) {
          const float scaled = column[r] * inverse;
          *to++ = static_cast<std::int16_t>(scaled + std::copysign(0.5F, scaled));
        }
      }
    }
  });
}

/// The panel of a supernode; above the diagonal stays what was there.
void CompactFactor::unpack(const Symbolic& symbolic, int s, float* panel) const {
  const int height = symbolic.height(s), width = symbolic.width(s);
  const std::int16_t* from = entries_.data() + start_[s];
  std::int64_t at = std::int64_t{symbolic.block_size} * symbolic.first_column[s];
  for (int c = 0; c < width; ++c, ++at, panel += height) {
    panel[c] = diagonal_[at];
    const float unit = unit_[at];
    float* const below = panel + c + 1;
    const int rows = height - c - 1;
    for (int r = 0; r < rows; ++r) below[r] = unit * static_cast<float>(from[r]);
    from += rows;
  }
}

void CompactFactor::solve(front::Vectors vectors, const Symbolic& symbolic, float* x, int columns,
                          const Work& work) const {
  const auto panel = [&](int s, std::vector<float>& space) -> const float* {
    const auto size = static_cast<std::size_t>(symbolic.height(s)) * symbolic.width(s);
    if (space.size() < size) space.resize(size);
    unpack(symbolic, s, space.data());
    return space.data();
  };
  solve_with_panels<float>(vectors, symbolic, panel, x, columns, work);
}

}  // namespace beltrami
