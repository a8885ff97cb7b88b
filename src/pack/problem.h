// Charts as a packer sees them: outlines, the grid of the pages, masks on it, and the way back.
#pragma once

#include <span>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "pack/greedy.h"
#include "pack/mask.h"
#include "pack/outline.h"
#include "pack/page.h"
#include "pack/types.h"

namespace beltrami {

using Masks = std::vector<std::vector<Mask>>;  // per chart, per turn

/// Keeps the references. Precondition: options in range.
class Problem {
 public:
  Problem(std::span<const PackChart> charts, std::vector<Outline> outlines,
          const PackOptions& options, const Work& work);

  Index size() const { return static_cast<Index>(charts_.size()); }
  const PackOptions& options() const { return options_; }
  const Work& work() const { return work_; }
  const PackChart& chart(Index c) const { return charts_[c]; }
  const Outline& outline(Index c) const { return outlines_[c]; }
  /// Areas and lengths at a density of one.
  double area(Index c) const { return chart(c).scale * chart(c).scale * outlines_[c].area; }
  double length(Index c) const { return chart(c).scale * outlines_[c].length; }
  /// The longer side of the least box of a chart, at a density of one: the greatest of all.
  double longest_side() const;

  /// Cells per side of a page, and texels per side of a cell.
  int cells() const { return cells_; }
  double cell() const { return cell_; }
  /// Half the margin, with what rounding takes, in texels.
  double radius() const;

  /// Whether there is time to look for a better order.
  bool few_to_order() const { return size() < kMostToOrder; }

  /// The density at which the charts with their margins would fill a share of the pages.
  /// Precondition: one has a length.
  double density_for(double share) const;

  /// What the charts with their margins take at a density, as a share of a page.
  double share_at(double density) const;
  /// The density at which they take `factor` times what they do at a density; no less than half of
  /// what is beyond the margins of points. Precondition: one has a length.
  double density_by(double density, double factor) const;

  /// The same charts on a grid of other cells to a page, where that may be.
  bool can_be_finer() const;
  Problem on_finest_grid() const;
  Problem on_coarse_grid() const;

  int turns() const { return turns_; }
  Vec2 turn(Index c, int k) const;

  /// Of the charts that are not kept, with half the margin and `spare` of it more.
  Masks masks(double texels_per_unit, double spare = 0) const;
  /// What these took, in words of bits that were looked at.
  static std::int64_t steps_of(const Masks& masks);
  /// Those charts, large ones first.
  std::vector<Index> order() const;
  /// Pages with the charts that are kept. Throws Error INVALID_ARGUMENT where max_pages has no page
  /// of that number.
  std::vector<Page> kept_pages(double texels_per_unit) const;

  /// The placements of a layout.
  std::vector<Placement> placements(const Masks& masks, const Layout& layout) const;
  /// A packing with its figures.
  Packing packing(std::vector<Placement> placements, double texels_per_unit) const;

 private:
  /// Charts up to which orders are searched for.
  static constexpr Index kMostToOrder = 500;

  /// Of all charts at a density of one.
  struct Sums {
    double area = 0, length = 0;
  };
  Sums sums() const;
  double half_margin() const;
  double room_of_points() const;
  double room_beside_points(const Sums& all, double density) const;
  double density_in(const Sums& all, double room) const;
  void set_cells(int cells);
  void thin_outlines();
  bool gains_from(int cells);

  std::span<const PackChart> charts_;
  const PackOptions& options_;
  const Work& work_;
  std::vector<Outline> outlines_;
  std::vector<Outline> thinned_;  // for masks: by a part of a cell
  std::vector<Vec2> base_;        // the turn from which a chart's others are counted
  int cells_ = 0, turns_ = 1;
  double cell_ = 1;
};

/// Where charts lie, and at which density.
struct Packed {
  std::vector<Placement> placements;
  double texels_per_unit = 0;
};

/// From a density at which charts do not fit to the next, while none is known at which they do.
inline constexpr double kStepDown = 0.8;

/// Densities that are tried, each lower than the one before, until margins are all that counts.
inline constexpr int kMostStepsDown = 60;

/// Sides of a page that are as high as the room in which layouts are made, to tell by how much they
/// are too high for the page.
inline constexpr double kStrip = 1.4;

}  // namespace beltrami
