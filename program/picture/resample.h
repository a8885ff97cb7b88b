// A texture of one layout of UVs, baked anew for another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// What a texture shows beyond its edges: its outermost texels, itself again, or itself mirrored at
/// every other time.
enum class Beyond { kClamp, kRepeat, kMirror };

/// A triangle in texels of the page that is baked.
using BakedTriangle = std::array<std::array<double, 2>, 3>;

/// Where a texel is read: on a page, whose texture is [0, 1]^2. Finite.
struct Source {
  std::uint64_t page = 0;
  double u = 0, v = 0;
};

/// The source of a point of a triangle, by the weights of its corners; none where there is none.
using SourceOf = std::function<std::optional<Source>(std::size_t triangle,
                                                     const std::array<double, 3>& weights)>;

struct Baked {
  Pixels image;
  std::uint64_t covered = 0, without_source = 0;  ///< texels, each once
};

/// Bakes a square page of `side` texels: what has its centre in a triangle is read from `pages`
/// between texels, bilinearly, `beyond` their edges as that says, and up to `margin` texels beside
/// what is read have the mean of their nearest neighbours; so have texels without a source. The
/// rest is 0. Rows are counted from the top, `triangles` from the bottom. Precondition: `pages`
/// have as many components and are not empty, and sources are on one of them.
Baked bake(const std::vector<BakedTriangle>& triangles, const SourceOf& source_of,
           const std::vector<Pixels>& pages, Beyond beyond, int side, int margin);

}  // namespace beltrami::cli
