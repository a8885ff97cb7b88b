#include "atlas/pages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "pack/pack.h"

namespace beltrami {
namespace {

/// The multiples of it are single-precision numbers as far as 1.
constexpr double kUnitStep = 0x1p-24;
/// Rounding to nearest moves a vertex by half of step_of in each direction, at most kUnitStep times
/// the greatest coordinate; two charts and a diagonal are worth 4 of them.
constexpr double kRounding = 4 * kUnitStep;
/// What mending moves further is rare: room for it is made where it is needed.
constexpr int kMostTries = 4;
constexpr double kMoreRoom = 2;

double greatest_coordinate(const PackOptions& options) {
  const Vec2 last = tile_of(std::max(options.max_pages, 1) - 1) + Vec2::Ones();
  return options.max_pages > 1 ? std::max(last.maxCoeff(), double{kPagesInARow}) : 1;
}

/// Throws Error NO_ROOM where a chart is longer than the diagonal of a page: told without drawing
/// what may be of any size.
void require_shorter_than_page(std::span<const PackChart> charts, const PackOptions& options) {
  const double longest = std::numbers::sqrt2 * options.resolution;
  const std::string remedy = " at these texels per unit: lower texels-per-unit, or raise ";
  std::string larger, of_face;
  double area = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const double density = options.texels_per_unit * charts[c].scale;
    const ChartExtent extent = extent_of(charts[c]);
    area += density * density * extent.area;
    if (charts[c].kept) continue;
    Eigen::AlignedBox2d box;
    for (const Vec2& p : charts[c].points) box.extend(p);
    if (box.isEmpty() || density * box.sizes().maxCoeff() <= longest) continue;
    if (larger.empty()) larger = "chart " + std::to_string(c);
    if (of_face.empty() && density * extent.edge > longest)
      of_face = "a face of chart " + std::to_string(c);
  }
  if (larger.empty()) return;
  // Charts are split for their pages, but not where these would be too few all the same.
  const double side = options.resolution;
  if (area > options.max_pages * side * side) {
    throw Error(Fault::kNoRoom, "the charts have more area than " +
                                    std::to_string(options.max_pages) +
                                    (options.max_pages == 1 ? " page" : " pages") + remedy +
                                    "the number of pages or resolution");
  }
  throw Error(Fault::kNoRoom, (of_face.empty() ? larger : of_face) + " is larger than a page" +
                                  remedy + "resolution");
}

/// What the packer refuses of options in their ranges is a lack of room.
Packing packed(std::span<const PackChart> charts, const PackOptions& options, const Work& work) {
  if (options.texels_per_unit > 0) require_shorter_than_page(charts, options);
  try {
    return pack_charts(charts, options, work);
  } catch (const Error& error) {
    if (error.fault() != Fault::kInvalidArgument) throw;
    throw Error(Fault::kNoRoom, error.what(), error.element());
  }
}

}  // namespace

ChartExtent extent_of(const PackChart& chart) {
  ChartExtent extent;
  for (const auto& [i, j, k] : chart.faces) {
    const Vec2 a = chart.points[j] - chart.points[i], b = chart.points[k] - chart.points[i];
    extent.edge = std::max({extent.edge, a.norm(), b.norm(), (b - a).norm()});
    extent.area += std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return extent;
}

double step_of(Index page) {
  const double reach = tile_of(page).maxCoeff() + 1;
  double step = kUnitStep;
  while (step < kUnitStep * reach) step *= 2;
  return step;
}

Packing pack_and_deliver(std::span<const PackChart> charts, const PackOptions& options,
                         const std::function<double(const Packing&, const Work&)>& deliver,
                         const Work& work) {
  double spare = kRounding * options.resolution * greatest_coordinate(options);
  if (options.snap) spare += 1;  // half a texel of each of two charts
  Packing packing;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    const double done = 1 - std::ldexp(1, -attempt);
    const Work own = work.part(done, 1 - std::ldexp(1, -attempt - 1));
    PackOptions with_room = options;
    with_room.margin =
        std::max(options.margin, std::min(options.margin + spare, 0.25 * options.resolution));
    packing = packed(charts, with_room, own.part(0, 0.9));
    const double margin = deliver(packing, own.part(0.9, 1));
    if (margin >= options.margin) break;
    spare += kMoreRoom * std::min(options.margin - margin, options.margin);
  }
  return packing;
}

Vec2 place_on_page(const Packing& packing, const PackChart& chart, const Placement& placement,
                   int resolution, const Vec2& point) {
  const double scale = packing.texels_per_unit * chart.scale;
  const Vec2& turn = placement.turn;
  const Vec2 turned(turn.x() * point.x() - turn.y() * point.y(),
                    turn.y() * point.x() + turn.x() * point.y());
  const Vec2 on_page = (placement.offset + scale * turned) / resolution;
  return tile_of(placement.page) + on_page.cwiseMax(0.0).cwiseMin(1.0);
}

void measure_pages(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                   const std::vector<Index>& chart_of_face, Pages& pages) {
  pages.page_utilisation.assign(static_cast<std::size_t>(pages.count), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (chart_of_face[f] == kNone) continue;
    const auto [a, b, c] = faces[f];
    const Vec2 p = uvs[b] - uvs[a], q = uvs[c] - uvs[a];
    pages.page_utilisation[pages.page_of_chart[chart_of_face[f]]] +=
        0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
  }
  pages.utilisation = 0;
  for (const double share : pages.page_utilisation) pages.utilisation += share;
  if (pages.count > 0) pages.utilisation /= pages.count;
}

}  // namespace beltrami
