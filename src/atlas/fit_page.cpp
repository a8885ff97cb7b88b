#include "atlas/fit_page.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "atlas/pack_maps.h"
#include "atlas/pages.h"
#include "base/vectors.h"
#include "pack/outline.h"

namespace beltrami {
namespace {

/// Texels that a chart takes on each axis beyond its own and the margin: it is drawn into whole
/// ones.
constexpr double kWholeTexels = 1;

using Box = Eigen::AlignedBox2d;

/// Of the box of a part as it stands, or `is_turned` of its least one, in the unit of the map.
Vec2 sizes_of(const PackChart& part, bool is_turned) {
  Vec2 turn(1, 0);
  if (is_turned) turn = turn_to_least_box(outline_of(part).hull);
  Box box;
  for (const Vec2& p : part.points) {
    box.extend(Vec2(turn.x() * p.x() - turn.y() * p.y(), turn.y() * p.x() + turn.x() * p.y()));
  }
  return box.sizes();
}

}  // namespace

std::vector<Index> larger_than_page(const std::vector<AtlasChart>& charts,
                                    const std::vector<MappedChart>& maps,
                                    const PackOptions& options) {
  const double side = options.resolution;
  const double room = (side - options.margin - kWholeTexels) / options.texels_per_unit;
  const double page = side / options.texels_per_unit;
  std::vector<Index> larger;
  double area = 0;
  for (Index c = 0; c < size_of(charts); ++c) {
    if (maps[c].error) continue;
    const PackChart part = real_part(charts[c], maps[c].uvs);
    const ChartExtent extent = extent_of(part);
    area += extent.area;
    if (extent.edge > std::numbers::sqrt2 * page) return {};
    const bool is_turned = (options.turns > 4 || options.upright) && maps[c].own_turns == 0;
    if (sizes_of(part, is_turned).maxCoeff() > room) larger.push_back(c);
  }
  if (area > options.max_pages * page * page) return {};
  return larger;
}

}  // namespace beltrami
