#include "atlas/place.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atlas/rows.h"
#include "base/parallel.h"
#include "base/types.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "repair/rounding.h"

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

/// What an atlas asks of a chart: positive faces that do not overlap.
bool is_sound(const AtlasChart& part, const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Triangle>& all = part.chart.mesh.faces;
  const std::vector<Triangle> faces(all.begin(), all.begin() + part.real_faces);
  return certify_atlas(faces, uvs, {}, work).injective();
}

/// As round_chart, with the pins where they are.
void round_pinned(const AtlasChart& part, int exponent, bool float32, const Work& work,
                  MappedChart& map) {
  const DiskMesh& mesh = part.chart.mesh;
  const Numbers doubles{.single = false, .exponent = exponent};
  const Numbers floats{.single = true, .exponent = exponent};
  map.uvs = round_map(mesh, map.uvs, map.uvs, map.held, doubles, work).uvs;
  Rounded single = round_map(mesh, map.uvs, map.uvs, map.held, floats, work);
  bool pins_stay = true;
  for (std::size_t v = 0; v < map.uvs.size(); ++v) {
    pins_stay = pins_stay && (!map.held[v] || single.uvs[v] == map.uvs[v]);
  }
  if (!is_sound(part, map.uvs, work)) {
    map.outcome = Outcome::kNotInjective;
  } else if (map.outcome > Outcome::kNotConverged) {
    map.outcome = Outcome::kOk;
  }
  const bool mended = single.moved > 0 && single.certificate.injective() && pins_stay;
  if (!float32 && !mended) return;
  map.uvs = std::move(single.uvs);
  if (float32 && map.outcome != Outcome::kNotInjective && !is_sound(part, map.uvs, work)) {
    map.outcome = Outcome::kNotInjectiveFloat32;
  }
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
  const Work of_chart = maps.size() == 1 ? work : work.aside();
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    if (maps[c].error) {
      for (Vec2& w : maps[c].uvs) w += shifts[c];
    } else if (maps[c].pinned()) {
      round_pinned(charts[c], exponent, float32, of_chart, maps[c]);
    } else {
      round_chart(charts[c].chart.mesh, shifts[c], exponent, float32, of_chart, maps[c]);
    }
  });
  return exponent;
}

}  // namespace beltrami
