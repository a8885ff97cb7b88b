// A call of beltrami_bake for images that were read.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "files/texture_use.h"
#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

using BakeProgress = std::function<void(double share)>;

struct BakeOutcome {
  std::uint64_t texels = 0, without_source = 0;
  double old_texels = 0;  ///< of the old images along the side of a new texel
};

/// What is baked; beltrami_bake_job says what it means.
struct BakeCall {
  static constexpr std::uint64_t kWholePage = std::numeric_limits<std::uint64_t>::max();
  /// The page of a face that has none.
  static constexpr std::uint64_t kNoPage = std::numeric_limits<std::uint64_t>::max();

  std::vector<Pixels> images;  ///< one for each old page; some may be without pixels
  Meaning meaning = Meaning::kNumbers;
  Reading reading;
  int side = 0;
  std::uint64_t gutter = kWholePage;
  std::uint64_t page_count = 1;
  std::vector<double> old_uvs, new_uvs;              ///< u v of each corner of triangles
  std::vector<std::uint64_t> old_pages, new_pages;   ///< of each triangle, or empty
  std::vector<double> positions, normals, tangents;  ///< of each corner, or empty
  std::vector<double> source_positions;              ///< of each corner of other triangles
  double cage = 0;
  std::uint64_t rays = 0;  ///< more than 0: ambient occlusion, and images are not read

  std::vector<Pixels> pages;  ///< the result

  /// Bakes `pages`. Throws Failure, which begins with `name`; most texels without a source are
  /// none.
  BakeOutcome run(beltrami_context* context, const std::string& name, const BakeProgress& progress);

 private:
  beltrami_bake_job job(const std::vector<beltrami_image>& views) const;
};

}  // namespace beltrami::cli
