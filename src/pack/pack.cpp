#include "pack/pack.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "pack/greedy.h"
#include "pack/mask.h"
#include "pack/outline.h"

namespace beltrami {
namespace {

/// Rounding to single precision moves a place by up to 2^-25 of the page per coordinate.
constexpr double kRoundingOfPage = 0x1p-22;

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Fault::kInvalidArgument, sentence);
}

void check(std::span<const PackChart> charts, const PackOptions& options) {
  if (options.resolution < 8 || options.resolution > 32768) {
    refuse("the resolution of a page is to be in [8, 32768] texels");
  }
  if (!(options.margin >= 0) || options.margin > options.resolution / 4) {
    refuse("the margin is to be in [0, a quarter of the resolution]");
  }
  if (!(options.texels_per_unit >= 0) || !std::isfinite(options.texels_per_unit)) {
    refuse("the texels per unit are to be a number >= 0");
  }
  if (options.turns != 1 && options.turns != 4 && (options.turns < 16 || options.turns > 360)) {
    refuse("the turns are to be 1, 4, or in [16, 360]");
  }
  if (options.block < 1 || options.block > options.resolution / 8) {
    refuse("the block is to be in [1, an eighth of the resolution]");
  }
  if (options.max_pages < 1) refuse("there is to be one page at least");
  if (!(options.effort >= 0) || !std::isfinite(options.effort)) {
    refuse("the effort is to be a number >= 0");
  }
  for (const PackChart& chart : charts) {
    if (!(chart.scale > 0) || !std::isfinite(chart.scale)) {
      refuse("a chart's scale is to be a number > 0");
    }
    if (chart.kept && !(options.texels_per_unit > 0)) {
      refuse("a chart keeps its place: give the texels per unit at which it was placed");
    }
  }
}

/// What is packed, and on what grid.
class Problem {
 public:
  Problem(std::span<const PackChart> charts, const PackOptions& options, const Work& work)
      : charts_(charts),
        options_(options),
        work_(work),
        outlines_(charts.size()),
        base_(charts.size(), Vec2(1, 0)) {
    parallel_for(work, size(), 16, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t c = begin; c < end; ++c) {
        outlines_[c] = outline_of(charts_[c]);
        if (options_.turns > 4) base_[c] = turn_to_least_box(outlines_[c].hull);
      }
    });
    cells_ = options.block > 1 ? options.resolution / options.block : options.resolution;
    cell_ = options.block > 1 ? options.block : static_cast<double>(options.resolution) / cells_;
  }

  Index size() const { return static_cast<Index>(charts_.size()); }
  double area(Index c) const { return charts_[c].scale * charts_[c].scale * outlines_[c].area; }

  Vec2 turn(Index c, int k) const {
    const int turns = options_.turns;
    Vec2 step;
    if (4 * k % turns == 0) {
      const std::array<Vec2, 4> quarters{Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
      step = quarters[4 * k / turns];
    } else {
      const double angle = 2 * std::numbers::pi * k / turns;
      step = {portable::cos(angle), portable::sin(angle)};
    }
    const Vec2 turn(base_[c].x() * step.x() - base_[c].y() * step.y(),
                    base_[c].y() * step.x() + base_[c].x() * step.y());
    return turn / portable::hypot(turn.x(), turn.y());
  }

  double radius() const {
    return (options_.margin / 2 + options_.resolution * kRoundingOfPage) / cell_;
  }

  std::vector<std::vector<Mask>> masks(double texels_per_unit) const {
    std::vector<std::vector<Mask>> masks(charts_.size());
    parallel_for(work_, size(), 4, [&](std::int64_t begin, std::int64_t end) {
      for (auto c = static_cast<Index>(begin); c < end; ++c) {
        if (charts_[c].kept || outlines_[c].edges.empty()) continue;
        for (int k = 0; k < options_.turns; ++k) {
          masks[c].push_back(mask_of(outlines_[c], turn(c, k),
                                     texels_per_unit * charts_[c].scale / cell_, radius()));
        }
      }
    });
    return masks;
  }

  /// Pages with the charts that are kept.
  std::vector<Page> kept_pages(double texels_per_unit) const {
    std::vector<Page> pages;
    for (Index c = 0; c < size(); ++c) {
      if (!charts_[c].kept) continue;
      const Placement& kept = *charts_[c].kept;
      if (kept.page < 0 || kept.page >= options_.max_pages) {
        refuse("a chart keeps its place on page " + std::to_string(kept.page) +
               ", beyond the pages that there may be: raise max_pages");
      }
      while (size_of(pages) <= kept.page) pages.emplace_back(cells_);
      const Mask mask = mask_at(outlines_[c], kept.turn, texels_per_unit * charts_[c].scale / cell_,
                                radius(), kept.offset / cell_, cells_);
      pages[kept.page].take(mask, 0, 0);
    }
    return pages;
  }

  /// Large ones first.
  std::vector<Index> order() const {
    std::vector<Index> order;
    for (Index c = 0; c < size(); ++c) {
      if (!charts_[c].kept) order.push_back(c);
    }
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      const auto size = [&](Index c) {
        return area(c) +
               charts_[c].scale * charts_[c].scale * outlines_[c].length * outlines_[c].length / 16;
      };
      return size(a) > size(b);
    });
    return order;
  }

  int cells() const { return cells_; }
  double cell() const { return cell_; }
  const PackOptions& options() const { return options_; }
  std::span<const PackChart> charts() const { return charts_; }
  const std::vector<Outline>& outlines() const { return outlines_; }

 private:
  std::span<const PackChart> charts_;
  PackOptions options_;
  Work work_;
  std::vector<Outline> outlines_;
  std::vector<Vec2> base_;
  int cells_ = 0;
  double cell_ = 1;
};

Packing deliver(const Problem& problem, const std::vector<std::vector<Mask>>& masks,
                const Layout& layout, double texels_per_unit) {
  Packing packing;
  packing.texels_per_unit = texels_per_unit;
  packing.placements.resize(problem.size());
  for (Index c = 0; c < problem.size(); ++c) {
    Placement& placement = packing.placements[c];
    if (problem.charts()[c].kept) {
      placement = *problem.charts()[c].kept;
    } else {
      const Spot& spot = layout.spots[c];
      placement.page = spot.page;
      if (masks[c].empty()) continue;
      placement.turn = problem.turn(c, spot.turn);
      placement.offset = problem.cell() * (Vec2(spot.x, spot.y) + masks[c][spot.turn].origin);
    }
    packing.pages = std::max(packing.pages, placement.page + 1);
  }
  packing.page_utilisation.resize(packing.pages, 0.0);
  const double page = static_cast<double>(problem.options().resolution);
  for (Index c = 0; c < problem.size(); ++c) {
    const double side = texels_per_unit / page;
    packing.page_utilisation[packing.placements[c].page] += problem.area(c) * side * side;
  }
  for (const double share : packing.page_utilisation) {
    packing.utilisation += share / packing.pages;
  }
  return packing;
}

/// The density at which the charts would fill a share of the pages.
double density_for(const Problem& problem, double share) {
  double area = 0, length = 0;
  for (Index c = 0; c < problem.size(); ++c) {
    area += problem.area(c);
    length += problem.charts()[c].scale * problem.outlines()[c].length;
  }
  // area d^2 + length r d + n pi r^2 = share pages side^2, in texels, with r = half the margin.
  const double radius = problem.radius() * problem.cell();
  const double side = problem.options().resolution;
  const double room = share * problem.options().max_pages * side * side;
  const double least = 0.1 * room;
  const double rest = std::max(least, room - problem.size() * std::numbers::pi * radius * radius);
  if (area > 0) {
    const double half = length * radius / 2;
    return (std::sqrt(half * half + area * rest) - half) / area;
  }
  return length > 0 ? side / length : 1;
}

Packing pack_at_largest(const Problem& problem) {
  const std::vector<Index> order = problem.order();
  double density = density_for(problem, 0.7), low = 0, high = 0;
  Packing best;
  for (int step = 0; step < 100; ++step) {
    const auto masks = problem.masks(density);
    const Layout layout = place_in_order(masks, order, Rule::kCorner, {},
                                         problem.options().max_pages, problem.cells());
    if (layout.failed == kNone) {
      low = density;
      best = deliver(problem, masks, layout, density);
    } else {
      high = density;
    }
    if (low > 0 && high > 0 && high < 1.005 * low) return best;
    if (low == 0) {
      density *= 0.9;
    } else {
      density = high == 0 ? 1.1 * density : 0.5 * (low + high);
    }
  }
  if (low > 0) return best;
  refuse("the margins of " + std::to_string(problem.size()) +
         " charts alone take more than the pages have: raise resolution or max_pages, or lower "
         "margin");
}

Packing pack_at(const Problem& problem, double density) {
  const auto masks = problem.masks(density);
  const Layout layout =
      place_in_order(masks, problem.order(), Rule::kCorner, problem.kept_pages(density),
                     problem.options().max_pages, problem.cells());
  if (layout.failed != kNone) {
    refuse("chart " + std::to_string(layout.failed) +
           " finds no room at these texels per unit: lower texels_per_unit, or raise resolution or "
           "max_pages");
  }
  return deliver(problem, masks, layout, density);
}

}  // namespace

Packing pack_charts(std::span<const PackChart> charts, const PackOptions& options,
                    const Work& work) {
  check(charts, options);
  if (charts.empty()) return {};
  const Problem problem(charts, options, work);
  if (options.texels_per_unit > 0) return pack_at(problem, options.texels_per_unit);
  return pack_at_largest(problem);
}

}  // namespace beltrami
