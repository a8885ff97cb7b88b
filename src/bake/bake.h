// Images of one layout of UVs, baked anew for another.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/image.h"
#include "bake/page.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Triangles with two layouts of UVs, and the images of the old one.
struct BakeProblem {
  /// One for each old page; of one type, with as many components. For kOcclusion one, of which that
  /// alone is looked at.
  std::vector<ImageView> images;
  ImageKind kind = ImageKind::kNumbers;
  ImageReading reading;
  int side = 0;                          ///< texels of a new page
  int rings = 0;                         ///< of gutters, or kWholePage
  std::vector<UvTriangle> new_uvs;       ///< in the unit square of their pages
  std::vector<std::uint32_t> new_pages;  ///< of each triangle; kNoPage for those that show nothing
  std::vector<SourceTriangle> sources;   ///< of the triangles, or of those of another surface
  /// Of the corners, x y z; for directions, and where there is another surface.
  std::vector<double> positions;
  /// Of the corners, for directions and with a cage: x y z, NaN for that of the triangle; or empty.
  std::vector<double> normals;
  std::vector<double> tangents;  ///< of the corners in the old layout: x y z and side; or empty
  /// Another surface of the same shape, by the places of which the image is read that are found
  /// along rays or nearest; or empty. Not for directions.
  std::vector<std::array<Vec3, 3>> source_places;
  double cage = 0;  ///< how far rays look for the other surface, outwards and inwards
  int rays = 0;     ///< from a point to the sky, for kOcclusion
};

struct BakeReport {
  BakedTexels texels;
  /// Texels of the old images along the side of a new texel, in the mean over the area of what has
  /// a source; 0 where that is another surface.
  double old_texels = 0;
};

/// Bakes all pages into `rooms`, which are as many. `masks` has a number for each texel of each
/// page, one page after another; or it is empty.
BakeReport bake(const BakeProblem& problem, std::span<const PageRoom> rooms,
                std::span<Filled> masks, const Work& work);

}  // namespace beltrami
