#include "atlas/place.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "atlas/round_chart.h"
#include "atlas/rows.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {
namespace {

/// Between maps with pins and the others, of the size of those and of their numbers.
constexpr double kGap = 1.0 / 1024, kRoundingGap = 1e-6;

Eigen::AlignedBox2d box_of(const std::vector<Vec2>& uvs) {
  Eigen::AlignedBox2d box;
  for (const Vec2& w : uvs) box.extend(w);
  return box;
}

/// Of the power of two that scales the unit square to hold the boxes, and what rounding adds.
int exponent_of_square(const std::vector<Vec2>& corners, const std::vector<Vec2>& sizes) {
  constexpr double kRounding = 1 + 1e-6;
  double extent = 0;
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    extent = std::max(extent, (corners[c] + sizes[c]).maxCoeff());
  }
  return extent > 0 ? std::ilogb(kRounding * extent) + 1 : 0;
}

/// Where the maps without pins move to: rows, above the box of those with pins.
std::vector<Vec2> shifts_of(const std::vector<MappedChart>& maps, bool unit_square, int& exponent) {
  std::vector<Vec2> shifts(maps.size(), Vec2::Zero()), sizes;
  std::vector<Index> free;
  Eigen::AlignedBox2d pinned;
  for (Index c = 0; c < size_of(maps); ++c) {
    const Eigen::AlignedBox2d box = box_of(maps[c].uvs);
    if (maps[c].pinned()) {
      pinned.extend(box);
    } else {
      free.push_back(c);
      sizes.push_back(box.sizes());
    }
  }
  if (free.empty() || (maps.size() == 1 && !unit_square)) return shifts;
  const std::vector<Vec2> corners = place_in_rows(sizes);
  if (unit_square) exponent = exponent_of_square(corners, sizes);
  Vec2 origin = Vec2::Zero();
  if (!pinned.isEmpty()) {
    const double gap = std::max(kGap * pinned.sizes().maxCoeff(),
                                kRoundingGap * pinned.max().cwiseAbs().maxCoeff());
    origin = {pinned.min().x(), pinned.max().y() + gap};
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    shifts[free[i]] = origin + corners[i] - box_of(maps[free[i]].uvs).min();
  }
  return shifts;
}

}  // namespace

int place_maps(const std::vector<AtlasChart>& charts, int exponent, bool unit_square, bool float32,
               std::vector<MappedChart>& maps, const Work& work) {
  const std::vector<Vec2> shifts = shifts_of(maps, unit_square, exponent);
  const NumberFormat numbers{.exponent = exponent, .float32 = float32};
  const Work of_chart = maps.size() == 1 ? work : work.aside();
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    if (maps[c].error) {
      for (Vec2& w : maps[c].uvs) w += shifts[c];
    } else if (maps[c].pinned()) {
      round_pinned(charts[c], numbers, of_chart, maps[c]);
    } else {
      std::vector<Vec2> placed = maps[c].uvs;
      for (Vec2& w : placed) w += shifts[c];
      round_chart(charts[c].chart.mesh, placed, numbers, of_chart, maps[c]);
    }
  });
  return exponent;
}

}  // namespace beltrami
