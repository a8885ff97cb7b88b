#include "pack/many.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "pack/greedy.h"
#include "pack/page.h"
#include "pack/types.h"

namespace beltrami {
namespace {

/// Of half the margin: by so much a layout may be higher than the page.
constexpr double kSpare = 0.04;

/// By how much the height of a layout may differ from the page's, times the number of the try.
constexpr double kNear = 0.015;

/// On the coarse grid, and after how many tries there it is left.
constexpr double kNearCoarse = 0.12;
constexpr int kTriesCoarse = 3;

/// What charts with their margins mostly fill; and of what they do on a grid on one of twice as
/// many cells, where less of the gaps counts as margin.
constexpr double kFirstShare = 0.84, kShareOfFiner = 0.965;

/// Charts that with their margins fill less of a page than this are packed on the finest grid: a
/// few long ones among them have not found the gaps that there are. Unless one is about as long as
/// the page: then that is what the density ends at.
constexpr double kPoorShare = 0.745, kLong = 0.97;

/// Layouts are rather too low than too high for the page.
constexpr double kBelow = 0.005;

/// Where an error above this is left after a step, the height is that of a few large charts, which
/// depends on the density and not on its square.
constexpr double kErrorOfFew = 0.04, kLongerForFew = 1.6;

class Strip {
 public:
  Strip(const Problem& problem, double spare)
      : problem_(problem),
        spare_(problem.options().block == 1 ? spare : 0),
        page_(problem.cells(), static_cast<int>(kStrip * problem.cells())),
        plan_{problem.order(), {}} {}

  double density() const { return density_; }
  /// The height of the last layout to that of the page; 0 where a chart is too long.
  double height() const { return height_; }
  const Packed& best() const { return best_; }

  void lay(double density) {
    density_ = density;
    const Masks masks = problem_.masks(density, spare_);
    const Layout layout = place_in_order(masks, plan_, Rule::kLowest, {}, page_, 1, pages_);
    height_ = layout.failed == kNone ? static_cast<double>(layout.height) / problem_.cells() : 0;
    if (height_ == 0 || height_ > 1 + spare_) return;
    const double scale = std::min(1.0, 1 / height_);
    if (scale * density <= best_.texels_per_unit) return;
    best_ = {problem_.placements(masks, layout), scale * density};
    for (Placement& placement : best_.placements) placement.offset *= scale;
  }

  /// A density at which the next layout is likely to be as high as the page.
  double next() {
    (height_ > 0 && height_ <= 1 + spare_ ? low_ : high_) = density_;
    if (height_ == 0) return kStepDown * density_;
    const double error = portable::log(height_);
    const bool few = std::abs(error) > kErrorOfFew && error * last_error_ > 0;
    last_error_ = error;
    const double next =
        problem_.density_by(density_, portable::exp(-(few ? kLongerForFew : 1) * error - kBelow));
    if (low_ > 0 && high_ > low_ && (next <= low_ || next >= high_)) {
      return std::sqrt(low_ * high_);
    }
    return next;
  }

  /// Whether no layout is to be expected that is much better than the best: by a share of its side.
  bool near(double share) const {
    if (!(best_.texels_per_unit > 0)) return false;
    return std::abs(height_ - 1) <= share || (high_ > low_ && high_ < (1 + share) * low_);
  }

 private:
  const Problem& problem_;
  double spare_;
  Page page_;
  std::vector<Page> pages_;
  Plan plan_;
  double density_ = 0, height_ = 0, last_error_ = 0;
  double low_ = 0, high_ = 0;  // densities that were low enough, and too high
  Packed best_;
};

/// The share of a page that charts with their margins fill on the grid of a problem.
double share_of_coarse(const Problem& problem) {
  Strip strip(problem, 0);
  strip.lay(problem.density_for(kFirstShare));
  for (int tries = 1; std::abs(strip.height() - 1) > kNearCoarse; ++tries) {
    if (tries >= kTriesCoarse && strip.height() > 0) break;
    if (tries > kMostStepsDown) break;
    strip.lay(strip.next());
  }
  return problem.share_at(strip.density()) / std::max(strip.height(), 0.1);
}

/// Packs in a few layouts, where charts with their margins fill about a share of the page.
Packed pack_near(const Problem& problem, double share) {
  Strip strip(problem, kSpare);
  strip.lay(problem.density_for(share));
  for (int tries = 1; tries <= kMostStepsDown; ++tries) {
    const double next = strip.next();
    if (strip.near(tries * kNear)) break;
    strip.lay(next);
  }
  return strip.best();
}

}  // namespace

Packed pack_many(const Problem& problem) {
  const Problem coarse = problem.on_coarse_grid();
  double share = share_of_coarse(coarse);
  for (int cells = coarse.cells(); cells < problem.cells(); cells *= 2) share *= kShareOfFiner;
  if (problem.can_be_finer() && share < kPoorShare) {
    const double longest = problem.density_for(share) * problem.longest_side();
    if (longest < kLong * problem.options().resolution) {
      return pack_near(problem.on_finest_grid(), kShareOfFiner * share);
    }
  }
  return pack_near(problem, share);
}

}  // namespace beltrami
