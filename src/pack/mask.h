// The cells of a grid that a chart takes with half the margin around it.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "pack/outline.h"

namespace beltrami {

/// Cells [begin, end) of a row.
struct Run {
  int row = 0, begin = 0, end = 0;
};

/// Squares of up to 2^7 cells per side are looked for.
inline constexpr int kSquareLevels = 7;

/// A square of 2^level cells per side that the mask takes whole.
struct Square {
  int x = 0, y = 0, level = 0;
};

/// A run as it is tested: two of 2^level cells, from the cells `left` and `right` on, are all of
/// it.
struct Probe {
  int row = 0, left = 0, right = 0, level = 0;
};

/// The largest of what masks ask of a page; by default anything.
struct Needs {
  int run_level = 31, square_level = kSquareLevels;
};

struct Mask {
  int width = 0, height = 0;    ///< of the box of its cells
  std::vector<Run> runs;        ///< by row, then by place
  std::vector<Probe> probes;    ///< the runs in the order in which to test them
  std::vector<Square> squares;  ///< together about the largest square in it
  std::int64_t cells = 0;
  Vec2 origin{0, 0};  ///< the place on the mask, in cells, of the chart's origin
  Needs needs{0, 0};
};

/// All cells that are less than `radius` from what the outline covers once it is turned by `turn`
/// and multiplied by `density` (cells per unit). The chart touches the mask's left and lower side.
/// Of one with more than `most` cells per side there is the size alone, that or a greater one.
Mask mask_of(const Outline& outline, const Vec2& turn, double density, double radius, int most);

/// The mask turned by 90 degrees about the origin of the chart, which touches what was its lower
/// side on the right, and by less than a cell not its lower one.
Mask quarter_turned(const Mask& mask);

/// Likewise by 180 degrees.
Mask half_turned(const Mask& mask);

/// Likewise, with the chart's origin at `origin` (cells); of cells [0, cells)^2 alone. The mask's
/// box is these, and its runs are where they are.
Mask mask_at(const Outline& outline, const Vec2& turn, double density, double radius,
             const Vec2& origin, int cells);

}  // namespace beltrami
