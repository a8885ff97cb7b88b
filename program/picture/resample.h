// A texture of one layout of UVs, baked anew for another.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// A triangle in texels of the page that is baked and in [0, 1]^2 of the page that is read.
struct BakedTriangle {
  std::array<std::array<double, 2>, 3> to, from;
  std::uint64_t from_page = 0;
};

/// Bakes a square page of `side` texels: what has its centre in a triangle is read from `pages`
/// between texels, bilinearly, and up to `margin` texels beside it have the mean of their nearest
/// neighbours. The rest is 0. Rows are counted from the top, `to` from the bottom. Precondition:
/// `pages` have as many components and are not empty, and `from_page` is one of them.
Pixels bake(const std::vector<BakedTriangle>& triangles, const std::vector<Pixels>& pages, int side,
            int margin);

}  // namespace beltrami::cli
