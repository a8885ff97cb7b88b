// How far apart charts lie on their pages, measured on the very numbers that are delivered.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Charts on pages: page k is the unit square whose lower left corner is tile_of(k).
struct PagedCharts {
  const std::vector<Triangle>& faces;       ///< indices of `uvs`
  const std::vector<Vec2>& uvs;             ///< in the plane of all pages
  const std::vector<Index>& chart_of_face;  ///< kNone leaves a face out
  const std::vector<Index>& page_of_chart;
  int resolution = 1024;        ///< texels to the side of a page
  std::vector<bool> kept = {};  ///< per chart: two of these are not compared; empty: none is
};

/// The least of the distances between the boundaries of two charts of a page and of twice the
/// distance of a boundary to the edge of its page (half a margin belongs to each side), in texels;
/// negative where a chart sticks out of its page, 0 where boundaries cross. In doubles, whose error
/// is some 1e-12 of a page. In O(n log n) for n edges at boundaries that are long against their
/// distance.
double least_margin(const PagedCharts& charts, const Work& work);

}  // namespace beltrami
