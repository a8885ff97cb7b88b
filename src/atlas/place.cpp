#include "atlas/place.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atlas/rows.h"
#include "base/parallel.h"
#include "base/types.h"
#include "chart/flattening.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

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

/// Rounds a map, moved by `shift`, to doubles that rounded to nearest stay injective in single
/// precision; or to single-precision numbers at once. Notes where it does not stay injective.
void round_chart(const DiskMesh& mesh, const Vec2& shift, int exponent, bool float32,
                 const Work& work, MappedChart& map) {
  const Numbers doubles{.single = false, .exponent = exponent};
  const Numbers floats{.single = true, .exponent = exponent};
  const bool was_injective = map.outcome <= Outcome::kNotConverged;
  const auto note = [&](const Numbers& numbers, const Certificate& certificate, Outcome outcome) {
    if (was_injective && !(numbers.hold(map.uvs) && certificate.injective())) {
      map.outcome = outcome;
    }
  };
  std::vector<Vec2> placed = map.uvs;
  for (Vec2& w : placed) w += shift;
  Rounded rounded = round_map(mesh, map.uvs, placed, doubles, work);
  map.uvs = std::move(rounded.uvs);
  note(doubles, rounded.certificate, Outcome::kNotInjective);
  Rounded single = round_map(mesh, map.uvs, map.uvs, floats, work);
  if (float32) {
    if (map.outcome != Outcome::kNotInjective) {
      note(floats, single.certificate, Outcome::kNotInjectiveFloat32);
    }
    map.uvs = std::move(single.uvs);
  } else if (single.moved > 0 && single.certificate.injective()) {
    map.uvs = std::move(single.uvs);
  }
}

}  // namespace

int place_maps(const std::vector<AtlasChart>& charts, int exponent, bool unit_square, bool float32,
               std::vector<MappedChart>& maps, const Work& work) {
  std::vector<Vec2> shifts(maps.size(), Vec2::Zero());
  if (maps.size() > 1 || unit_square) {
    std::vector<Vec2> sizes;
    for (const MappedChart& map : maps) sizes.push_back(box_of(map.uvs).sizes());
    shifts = place_in_rows(sizes);
    if (unit_square) exponent = exponent_of_square(shifts, sizes);
    for (std::size_t c = 0; c < maps.size(); ++c) shifts[c] -= box_of(maps[c].uvs).min();
  }
  const Work of_chart = maps.size() == 1 ? work : work.aside();
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    if (maps[c].error != BELTRAMI_OK) {
      for (Vec2& w : maps[c].uvs) w += shifts[c];
      return;
    }
    round_chart(charts[c].chart.mesh, shifts[c], exponent, float32, of_chart, maps[c]);
  });
  return exponent;
}

}  // namespace beltrami
