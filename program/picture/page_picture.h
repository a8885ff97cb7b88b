// One image of pages: charts in colours of their own, side by side as UDIM has them.
#pragma once

#include <cstdint>
#include <vector>

#include "picture/picture.h"

namespace beltrami::cli {

/// Triangles in the plane of the pages.
struct PageTriangles {
  std::vector<double> uvs;            ///< u v of each corner, three corners per triangle
  std::vector<std::uint64_t> charts;  ///< per triangle
};

/// Draws the pages, at most 10 in a row, the first at the lower left.
Image render_pages(const PageTriangles& triangles, std::uint64_t pages);

}  // namespace beltrami::cli
