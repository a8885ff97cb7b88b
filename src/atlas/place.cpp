#include "atlas/place.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "atlas/pack_maps.h"
#include "atlas/round_chart.h"
#include "atlas/rows.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "pack/outline.h"

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

/// The turn (cosine, sine) that lays the longer side of a map's least box along x.
Vec2 upright(const AtlasChart& chart, const MappedChart& map) {
  if (map.error) return {1, 0};
  if (map.own_turns == 2) return {1, 0};
  if (map.own_turns == 4) {
    const Vec2 sizes = box_of(map.uvs).sizes();
    return sizes.x() < sizes.y() ? Vec2(0, 1) : Vec2(1, 0);
  }
  return turn_to_least_box(outline_of(chart, map.uvs).hull);
}

std::vector<Vec2> turned(const Vec2& turn, std::vector<Vec2> uvs) {
  for (Vec2& w : uvs) {
    w = {turn.x() * w.x() - turn.y() * w.y(), turn.y() * w.x() + turn.x() * w.y()};
  }
  return uvs;
}

/// Moves the maps without pins, which stand upright, into rows, above the box of those with pins.
void shift(const std::vector<MappedChart>& maps, bool unit_square, int& exponent,
           std::vector<std::vector<Vec2>>& placed) {
  std::vector<Vec2> sizes;
  std::vector<Index> free;
  Eigen::AlignedBox2d pinned;
  for (Index c = 0; c < size_of(maps); ++c) {
    const Eigen::AlignedBox2d box = box_of(placed[c]);
    if (maps[c].pinned()) {
      pinned.extend(box);
    } else {
      free.push_back(c);
      sizes.push_back(box.sizes());
    }
  }
  if (free.empty()) return;
  const std::vector<Vec2> corners = place_in_rows(sizes);
  if (unit_square) exponent = exponent_of_square(corners, sizes);
  Vec2 origin = Vec2::Zero();
  if (!pinned.isEmpty()) {
    const double gap = std::max(kGap * pinned.sizes().maxCoeff(),
                                kRoundingGap * pinned.max().cwiseAbs().maxCoeff());
    origin = {pinned.min().x(), pinned.max().y() + gap};
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Vec2 by = origin + corners[i] - box_of(placed[free[i]]).min();
    for (Vec2& w : placed[free[i]]) w += by;
  }
}

}  // namespace

int place_maps(const std::vector<AtlasChart>& charts, int exponent, bool unit_square, bool float32,
               std::vector<MappedChart>& maps, const Work& work) {
  const bool stays = maps.size() == 1 && !unit_square;
  std::vector<std::vector<Vec2>> placed(maps.size());
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    const MappedChart& map = maps[c];
    placed[c] = map.pinned() || stays ? map.uvs : turned(upright(charts[c], map), map.uvs);
  });
  if (!stays) shift(maps, unit_square, exponent, placed);
  const NumberFormat numbers{.exponent = exponent, .float32 = float32};
  const Work of_chart = maps.size() == 1 ? work : work.aside();
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    if (maps[c].error) {
      maps[c].uvs = placed[c];
    } else if (maps[c].pinned()) {
      round_pinned(charts[c], numbers, of_chart, maps[c]);
    } else {
      round_chart(charts[c].chart.mesh, placed[c], numbers, of_chart, maps[c]);
    }
  });
  return exponent;
}

}  // namespace beltrami
