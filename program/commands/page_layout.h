// Where UVs from anywhere lie on the pages of a texture, how far apart, and how dense.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// What some faces have of the texels of a page.
struct Density {
  std::string name;              ///< of what they are, or ""
  std::uint64_t first_face = 0;  ///< of the file
  double area = 0;               ///< on the surface
  double texels_per_unit = 0;    ///< of length; 0 where there is no area
};

/// Lengths are in texels of pages with `resolution` of them to the side.
struct PageLayout {
  std::array<double, 2> low{}, high{};  ///< the box around all UVs
  std::vector<std::uint64_t> tiles;     ///< of UDIM, 1001 and so on, that charts are in; ascending
  std::uint64_t charts = 0;
  std::uint64_t outside = 0;  ///< charts that leave [0,1]^2
  std::uint64_t astride = 0;  ///< charts that leave the tile that they begin in, or lie in none
  std::uint64_t resolution = 0;
  std::optional<double> chart_distance;  ///< the least of two charts; none where there is one
  double edge_distance = 0;  ///< the least from a UV to the edges of its page; negative outside
  double margin = 0;         ///< the least of chart_distance and twice edge_distance, not below 0
  std::optional<double> density, least_density,
      greatest_density;                       ///< per unit: mean, and of charts
  double utilisation = 0;                     ///< area of UVs over that of the tiles
  std::vector<Density> of_charts, of_labels;  ///< by their first faces
};

/// `corners`: of the file's faces, three for each triangle, with finite UVs. `labels`: as
/// face_labels has it, or "". Throws Failure where interrupted(), or where the file has no such
/// labels; std::bad_alloc.
PageLayout page_layout(const MeshFile& file, const std::vector<std::uint32_t>& corners,
                       std::uint64_t resolution, const std::string& labels);

}  // namespace beltrami::cli
