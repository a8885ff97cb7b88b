// What is packed, how, and what comes of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// Where a chart lies: a rotation, never a mirror image, and a shift.
struct Placement {
  Index page = 0;
  Vec2 turn{1, 0};    ///< cosine and sine
  Vec2 offset{0, 0};  ///< in texels of the page

  /// The place of a chart's point on the page, in texels; `density` is the texels per unit of the
  /// chart: those of the packing times the chart's scale.
  Vec2 place(const Vec2& point, double density) const {
    return offset + density * Vec2(turn.x() * point.x() - turn.y() * point.y(),
                                   turn.y() * point.x() + turn.x() * point.y());
  }
};

/// What is packed as one piece.
struct PackChart {
  std::vector<Vec2> points;            ///< finite
  std::vector<Triangle> faces;         ///< may be folded or overlap: what they cover counts
  double scale = 1;                    ///< its density to that of the others, > 0
  std::optional<Placement> kept = {};  ///< where it stays
  int own_turns = 0;                   ///< 4: quarter turns alone are tried, from what it is; 2:
                                       ///< half turns; 1: it is not turned; 0: as the others
  std::uint64_t group = 0;             ///< charts of different groups share no page
};

struct PackOptions {
  int resolution = 1024;       ///< texels per side of a page, [8, 32768]
  double margin = 2;           ///< texels between charts, half of it to the page's edges; >= 0
  double texels_per_unit = 0;  ///< 0: as many as fit into max_pages
  int turns = 16;              ///< rotations that are tried: 16 or more, 4 quarter turns or 1, none
  bool upright = false;        ///< 4 and 1 start from each chart's least box, its longer side
                               ///< along x; else from the chart as it is
  bool snap = false;           ///< whoever places the charts moves them by up to half a texel, onto
                               ///< texel edges
  int block = 1;               ///< charts share no block of so many texels per side
  int max_pages = 1;           ///< of each group
  double effort = 1;  ///< work spent on trying other orders, to the default; 0: the first that fits
};

struct Packing {
  std::vector<Placement> placements;  ///< one per chart
  int pages = 0;
  double texels_per_unit = 0;
  double utilisation = 0;                ///< area of the charts' faces to that of the pages
  std::vector<double> page_utilisation;  ///< likewise, per page
};

}  // namespace beltrami
