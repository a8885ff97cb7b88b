#include "pack/problem.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"

namespace beltrami {
namespace {

/// Rounding to single precision moves a place by up to 2^-25 of the page per coordinate.
constexpr double kRoundingOfPage = 0x1p-22;

/// Cells per side of a page: with more of them masks are tighter and all is slower. With few charts
/// there is time for more orders on fewer cells; of many, thin or tiny ones need more, as half a
/// cell is much to them.
constexpr int kCellsOfFew = 512, kCells = 1024, kMostCells = 1536;
constexpr Index kFew = 20;

/// The share by which charts with their margins are to take less room on the finer grid.
constexpr double kWorthFiner = 0.033;

/// From so many charts on quarter turns are enough: there is always one that fits well.
constexpr Index kManyForTurns = 500;

/// Masks are drawn up to so many times the side of a page.
constexpr int kMostOfPage = 2;

/// Of a cell: by how much borders may be off in masks, which makes up for it.
constexpr double kThin = 1.0 / 16;

/// Of so many turns a chart with few of its own takes each in the place of all up to its next one,
/// which is so many further.
int turns_at_once(const PackChart& chart, int turns) {
  return chart.own_turns == 0 ? 1 : std::max(1, turns / chart.own_turns);
}

/// A density that none exceeds whose charts fit into the pages.
double greatest_density(const PackOptions& options, double area) {
  if (options.texels_per_unit > 0) return options.texels_per_unit;
  const double side = options.resolution;
  return std::sqrt(options.max_pages * side * side / area);
}

}  // namespace

Problem::Problem(std::span<const PackChart> charts, std::vector<Outline> outlines,
                 const PackOptions& options, const Work& work)
    : charts_(charts),
      options_(options),
      work_(work),
      outlines_(std::move(outlines)),
      base_(charts.size(), Vec2(1, 0)) {
  parallel_for(work, size(), 16, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end && (options_.turns > 4 || options_.upright); ++c) {
      if (charts_[c].own_turns == 0) base_[c] = turn_to_least_box(outlines_[c].hull);
    }
  });
  turns_ = options.turns;
  if (size() >= kManyForTurns) turns_ = std::min(turns_, 4);
  if (options.block > 1) {
    cells_ = options.resolution / options.block;
    cell_ = options.block;
  } else {
    set_cells(size() < kFew ? kCellsOfFew : kCells);
    if (!few_to_order() && gains_from(kMostCells)) set_cells(kMostCells);
  }
  thin_outlines();
}

void Problem::thin_outlines() {
  const double sum = sums().area;
  thinned_ = outlines_;
  if (!(sum > 0)) return;
  const double width = kThin * cell_ / greatest_density(options_, sum);
  parallel_for(work_, size(), 16, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) thin(thinned_[c], width / charts_[c].scale);
  });
}

bool Problem::can_be_finer() const {
  return options_.block == 1 && cells_ < kMostCells;
}

Problem Problem::on_finest_grid() const {
  Problem finer = *this;
  finer.set_cells(kMostCells);
  finer.thin_outlines();
  return finer;
}

Problem Problem::on_coarse_grid() const {
  Problem coarse = *this;  // what is thinned for finer cells serves
  coarse.set_cells(std::min(cells_, kCellsOfFew));
  return coarse;
}

double Problem::longest_side() const {
  double longest = 0;
  for (Index c = 0; c < size(); ++c) {
    const Vec2 turn = turn_to_least_box(outlines_[c].hull);
    Eigen::AlignedBox1d side;
    for (const Vec2& p : outlines_[c].hull) {
      side.extend(Eigen::Matrix<double, 1, 1>(turn.x() * p.x() - turn.y() * p.y()));
    }
    if (!side.isEmpty()) longest = std::max(longest, chart(c).scale * side.sizes().x());
  }
  return longest;
}

void Problem::set_cells(int cells) {
  cells_ = cells;
  cell_ = static_cast<double>(options_.resolution) / cells;
}

Problem::Sums Problem::sums() const {
  Sums sums;
  for (Index c = 0; c < size(); ++c) {
    sums.area += area(c);
    sums.length += length(c);
  }
  return sums;
}

/// Solves area d^2 + length r d = room for d, with r half the margin and half a cell. The usual
/// formula has a difference, of which long charts without much area would leave nothing.
double Problem::density_in(const Sums& all, double room) const {
  const double half = all.length * half_margin() / 2;
  return room / (half + std::sqrt(half * half + all.area * room));
}

double Problem::half_margin() const {
  return radius() + cell_ / 2;
}

/// What the margins of points take, in square texels.
double Problem::room_of_points() const {
  return size() * std::numbers::pi * half_margin() * half_margin();
}

double Problem::density_for(double share) const {
  const Sums all = sums();
  const double side = options_.resolution;
  const double room = share * options_.max_pages * side * side;
  if (!(all.area > 0)) return side / all.length;
  return density_in(all, std::max(0.02 * room, room - room_of_points()));
}

double Problem::share_at(double density) const {
  const double side = options_.resolution;
  return (room_beside_points(sums(), density) + room_of_points()) / (side * side);
}

double Problem::density_by(double density, double factor) const {
  const Sums all = sums();
  const double room = room_beside_points(all, density), points = room_of_points();
  return density_in(all, std::max(0.5 * room, factor * (room + points) - points));
}

double Problem::room_beside_points(const Sums& all, double density) const {
  return all.area * density * density + all.length * half_margin() * density;
}

/// Whether with so many cells to a page the charts take that much less room.
bool Problem::gains_from(int cells) {
  constexpr double kFull = 0.85;  // of a page
  if (!(sums().length > 0)) return false;
  const double density =
      options_.texels_per_unit > 0 ? options_.texels_per_unit : density_for(kFull);
  const int given = cells_;
  const double share = share_at(density);
  set_cells(cells);
  const bool gains = share > (1 + kWorthFiner) * share_at(density);
  set_cells(given);
  return gains;
}

double Problem::radius() const {
  return options_.margin / 2 + options_.resolution * kRoundingOfPage;
}

Vec2 Problem::turn(Index c, int k) const {
  k -= k % turns_at_once(charts_[c], turns_);
  Vec2 step;
  if (4 * k % turns_ == 0) {
    const std::array<Vec2, 4> quarters{Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
    step = quarters[4 * k / turns_];
  } else {
    const double angle = 2 * std::numbers::pi * k / turns_;
    step = {portable::cos(angle), portable::sin(angle)};
  }
  const Vec2 turn(base_[c].x() * step.x() - base_[c].y() * step.y(),
                  base_[c].y() * step.x() + base_[c].x() * step.y());
  return turn / portable::hypot(turn.x(), turn.y());
}

Masks Problem::masks(double texels_per_unit, double spare) const {
  Masks masks(charts_.size());
  parallel_for(work_, size(), 4, [&](std::int64_t begin, std::int64_t end) {
    for (auto c = static_cast<Index>(begin); c < end; ++c) {
      if (charts_[c].kept || outlines_[c].edges.empty()) continue;
      const double density = texels_per_unit * charts_[c].scale / cell_;
      const int quarter = turns_ % 4 == 0 ? turns_ / 4 : turns_;
      masks[c].reserve(turns_);
      for (int k = 0; k < turns_; ++k) {
        if (k % turns_at_once(charts_[c], turns_) != 0) {
          masks[c].push_back(masks[c].back());
          continue;
        }
        if (k >= 2 * quarter) {
          masks[c].push_back(half_turned(masks[c][k - 2 * quarter]));
          continue;
        }
        if (k >= quarter) {
          masks[c].push_back(quarter_turned(masks[c][k - quarter]));
          continue;
        }
        masks[c].push_back(mask_of(thinned_[c], turn(c, k), density,
                                   (1 + spare) * radius() / cell_ + kThin, kMostOfPage * cells_));
      }
    }
  });
  return masks;
}

std::int64_t Problem::steps_of(const Masks& masks) {
  std::int64_t steps = 0;
  for (const auto& of_chart : masks) {
    for (const Mask& mask : of_chart) {
      steps += mask.height * (40 + mask.width / 16);
    }
  }
  return steps;
}

std::vector<Index> Problem::order() const {
  std::vector<Index> order;
  std::vector<double> extent(charts_.size());
  for (Index c = 0; c < size(); ++c) {
    // Thin charts find a place less easily than round ones of their area.
    extent[c] = area(c) + length(c) * length(c) / 16;
    if (!charts_[c].kept) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return extent[a] > extent[b]; });
  return order;
}

std::vector<Page> Problem::kept_pages(double texels_per_unit) const {
  std::vector<Page> pages;
  for (Index c = 0; c < size(); ++c) {
    if (!charts_[c].kept) continue;
    const Placement& kept = *charts_[c].kept;
    if (kept.page < 0 || kept.page >= options_.max_pages) {
      throw Error(Fault::kInvalidArgument,
                  "chart " + std::to_string(c) + " keeps its place on page " +
                      std::to_string(kept.page) +
                      ", which is not among those that there may be: raise max-pages");
    }
    while (size_of(pages) <= kept.page) {
      poll_interrupt();
      pages.emplace_back(cells_, cells_);
    }
    const double density = texels_per_unit * charts_[c].scale / cell_;
    const Mask mask = mask_at(thinned_[c], kept.turn, density, radius() / cell_ + kThin,
                              kept.offset / cell_, cells_);
    pages[kept.page].take(mask, 0, 0);
  }
  return pages;
}

std::vector<Placement> Problem::placements(const Masks& masks, const Layout& layout) const {
  std::vector<Placement> placements(charts_.size());
  for (Index c = 0; c < size(); ++c) {
    if (charts_[c].kept) {
      placements[c] = *charts_[c].kept;
      continue;
    }
    const Spot& spot = layout.spots[c];
    placements[c].page = spot.page;
    if (masks[c].empty()) continue;
    placements[c].turn = turn(c, spot.turn);
    placements[c].offset = cell_ * (Vec2(spot.x, spot.y) + masks[c][spot.turn].origin);
  }
  return placements;
}

Packing Problem::packing(std::vector<Placement> placements, double texels_per_unit) const {
  Packing packing;
  packing.texels_per_unit = texels_per_unit;
  for (const Placement& placement : placements) {
    packing.pages = std::max(packing.pages, placement.page + 1);
  }
  packing.page_utilisation.resize(packing.pages, 0.0);
  const double side = texels_per_unit / options_.resolution;
  for (Index c = 0; c < size(); ++c) {
    packing.page_utilisation[placements[c].page] += area(c) * side * side;
  }
  for (const double share : packing.page_utilisation) {
    packing.utilisation += share / packing.pages;
  }
  packing.placements = std::move(placements);
  return packing;
}

}  // namespace beltrami
