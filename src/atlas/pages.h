// Pages of a texture: where they lie in the plane, and what is packed onto them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "pack/types.h"

namespace beltrami {

/// Pages in a row of the plane, as UDIM numbers them: 1001 + page.
inline constexpr int kPagesInARow = 10;

/// The lower left corner of the unit square that is the page.
inline Vec2 tile_of(Index page) {
  const Index column = page % kPagesInARow, row = page / kPagesInARow;
  return {static_cast<double>(column), static_cast<double>(row)};
}

/// The least power of two of which single precision holds every multiple on the page, and 1 less
/// each of them, so that v may be stored with its axis up or down. Corners of pages are multiples
/// of it.
double step_of(Index page);

/// What charts were split for.
struct SplitFigures {
  double before = 0;  ///< the utilisation of the charts whole
  Index count = 0;    ///< splits: each makes two of one
  double length = 0;  ///< of their seams, in roots of the surface's area
};

/// Charts on their pages.
struct Pages {
  int count = 0;
  int resolution = 0;                    ///< texels to the side of each
  double texels_per_unit = 0;            ///< of the surface, where a chart's density is 1
  double asked_margin = 0;               ///< texels
  double margin = 0;                     ///< least_margin of the numbers that are delivered
  double utilisation = 0;                ///< area of the UVs over that of the pages
  std::vector<double> page_utilisation;  ///< of each page
  std::vector<Index> page_of_chart;
  std::optional<SplitFigures> split;  ///< where splits were asked for
};

/// Packs charts, and again with more room between them as long as the margin that `deliver` returns
/// is less than what `options` ask for: rounding moves vertices. `deliver` puts the charts where
/// the packing says and returns their least_margin. Throws Error NO_ROOM where the charts do not
/// fit.
Packing pack_and_deliver(std::span<const PackChart> charts, const PackOptions& options,
                         const std::function<double(const Packing&, const Work&)>& deliver,
                         const Work& work);

/// Where a packing puts a point of a chart, in the plane of all pages and within its page.
Vec2 place_on_page(const Packing& packing, const PackChart& chart, const Placement& placement,
                   int resolution, const Vec2& point);

/// Of a chart, in its unit: its longest edge, and its area.
struct ChartExtent {
  double edge = 0, area = 0;
};
ChartExtent extent_of(const PackChart& chart);

/// Sets the shares of the pages that the faces cover, each counted once.
void measure_pages(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                   const std::vector<Index>& chart_of_face, Pages& pages);

}  // namespace beltrami
