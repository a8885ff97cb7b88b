// One page of a texture, baked anew for other UVs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/image.h"
#include "bake/texture.h"
#include "base/work.h"

namespace beltrami {

/// Where a triangle is on an old page, whose image is [0, 1]^2; finite unless the page is kNoPage.
struct SourceTriangle {
  std::uint32_t page = 0;
  UvTriangle uvs{};
};

/// How directions along the axes of the old UVs are said along those of the new ones.
struct AxesTurn {
  /// Cosine and sine, at each corner, of the angle from the new axis of u to the old one.
  std::array<std::array<double, 2>, 3> corners = {{{1, 0}, {1, 0}, {1, 0}}};
  double old_side = 1, new_side = 1;  ///< -1 where the UVs are mirrored
};

/// Adds what a point of a triangle shows, by the weights of its corners; false where there is
/// nothing. `part` is the number of the point among the kPartsOfTexel of a texel that is parted, or
/// kWholeTexel. `hint` is the caller's, one for each thread: what was found last. Called from
/// several threads.
using ShowPoint = std::function<bool(std::size_t triangle, const std::array<double, 3>& weights,
                                     int part, std::size_t& hint, TexelSums& sums)>;
inline constexpr int kPartsOfTexel = 16, kWholeTexel = -1;

/// What a page of `side` texels is baked of. Where triangles overlap, the first is shown.
struct PageBake {
  std::span<const UvTriangle> triangles;    ///< in texels of the page; rows from the bottom
  std::span<const SourceTriangle> sources;  ///< of the triangles; or `show` is asked
  ShowPoint show;
  std::span<const AxesTurn> turns;      ///< of the triangles, for textures of directions; or none
  std::span<const std::uint8_t> seams;  ///< see inner_seams(), of the triangles; or none
  std::span<Texture> pages;             ///< of one type, with as many components
  ImageReading reading;
  int side = 0;
};

/// Pixels of a page in the caller's memory, rows from the top, of the type and components of the
/// images.
struct PageRoom {
  unsigned char* pixels = nullptr;
  std::size_t row_bytes = 0;
  int side = 0, components = 0;
  PixelType type = PixelType::kByte;
};

/// What a texel of a page got.
enum class Filled : std::uint8_t { kNothing = 0, kGutter = 1, kBaked = 2 };

struct BakedTexels {
  std::uint64_t covered = 0, without_source = 0;  ///< each once
};

/// Per triangle, bits 1, 2 and 4 for the sides across from its corners where a triangle joins it on
/// the new page, but not on the old one: what is shown may change there at once.
std::vector<std::uint8_t> inner_seams(std::span<const UvTriangle> triangles,
                                      std::span<const SourceTriangle> sources);

/// Bakes a page; 0 where nothing is. `filled` has an item for each texel, and says where something
/// was baked. A texel whose centre is in a triangle that shows no more texels of the old page
/// than it has itself is read there, bilinearly: once, which leaves it as sharp as it can be. Where
/// a texel shows more of them it is the mean of up to 4 x 4 places in it, each on the triangle that
/// it lies in, of a smaller image where even these are too few. So are texels that a seam of the
/// old page goes through, and those that only a part of a triangle is in, of the places that are.
/// The bits do not depend on the number of threads. Makes smaller images of `job.pages`.
BakedTexels bake_page(const PageBake& job, const PageRoom& room, std::span<Filled> filled,
                      const Work& work);

}  // namespace beltrami
