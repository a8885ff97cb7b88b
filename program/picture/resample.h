// Textures of one layout of UVs, baked anew for another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "files/texture_use.h"
#include "picture/stb_in_one_place.h"
#include "picture/texture.h"

namespace beltrami::cli {

/// A triangle in texels of the page that is baked; rows are counted from the bottom.
using BakedTriangle = std::array<std::array<double, 2>, 3>;

inline constexpr std::uint64_t kNoPage = std::numeric_limits<std::uint64_t>::max();

/// Where a triangle is on an old page, whose texture is [0, 1]^2; finite unless the page is
/// kNoPage, which has none.
struct SourceTriangle {
  std::uint64_t page = 0;
  std::array<std::array<double, 2>, 3> uvs{};
};

/// How directions along the axes of the old UVs are said along those of the new ones.
struct AxesTurn {
  /// Cosine and sine, at each corner, of the angle from the new axis of u to the old one.
  std::array<std::array<double, 2>, 3> corners = {{{1, 0}, {1, 0}, {1, 0}}};
  double old_side = 1, new_side = 1;  ///< -1 where the UVs are mirrored
};

/// Where a texel is read.
struct Source {
  std::uint64_t page = 0;
  double u = 0, v = 0;
};

/// The source of a point of a triangle, by the weights of its corners; none where there is none.
using SourceOf = std::function<std::optional<Source>(std::size_t triangle,
                                                     const std::array<double, 3>& weights)>;

/// What a page of `side` texels is baked of. Where triangles overlap, the first is shown.
struct BakeJob {
  std::span<const BakedTriangle> triangles;
  std::span<const SourceTriangle> sources;  ///< of the triangles; or `source_of` is asked
  SourceOf source_of;                       ///< by one thread at a time, a point for each texel
  std::span<const AxesTurn> turns;      ///< of the triangles, for textures of directions; or none
  std::span<const std::uint8_t> seams;  ///< see inner_seams(), of the triangles; or none
  std::span<Texture> pages;             ///< that have as many components
  Reading reading;
  int side = 0;
  int threads = 1;
  std::function<void(double)> progress;  ///< is told the share that is done; or empty
};

/// Per triangle, bits 1, 2 and 4 for the sides across from its corners where a triangle joins it on
/// the new page, but not on the old one: what is shown may change there at once.
std::vector<std::uint8_t> inner_seams(std::span<const BakedTriangle> triangles,
                                      std::span<const SourceTriangle> sources);

/// A page, rows from the top; 0 where nothing was baked.
struct Baked {
  Pixels image;
  std::vector<std::uint8_t> filled;               ///< per texel: 1 where something was
  std::uint64_t covered = 0, without_source = 0;  ///< texels, each once
};

/// Bakes a page. A texel whose centre is in a triangle that shows no more texels of the old page
/// than it has itself is read there, bilinearly: once, which leaves it as sharp as it can be. Where
/// a texel shows more of them it is the mean of up to 4 x 4 places in it, each on the triangle that
/// it lies in, of a smaller image where even these are too few. So are texels that a seam of the
/// old page goes through, and those that only a part of a triangle is in, of the places that are.
/// The bits do not depend on the number of threads.
Baked bake(const BakeJob& job);

/// Fills gutters: in each of `rings` rounds, or until all is full, texels beside filled ones get
/// the mean of these.
void fill_gutters(Baked& baked, int rings);

}  // namespace beltrami::cli
