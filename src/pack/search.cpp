#include "pack/search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bracket.h"
#include "base/error.h"
#include "base/types.h"
#include "pack/greedy.h"
#include "pack/grow.h"
#include "pack/many.h"
#include "pack/mask.h"
#include "pack/page.h"

namespace beltrami {
namespace {

/// Words of masks and pages that the search for a better order may look at, at an effort of one:
/// about half a second.
constexpr double kSteps = 1.6e8;

/// What charts with their margins mostly fill of a page.
constexpr double kFirstShare = 0.75;

/// From a density at which charts fit to the next, while none is known at which they do not.
constexpr double kStepUp = 1.05;

/// Disks of half the margin fill no more of a plane than this.
constexpr double kDensestDisks = 0.9069;

[[noreturn]] void refuse_margins(const Problem& problem) {
  throw Error(Fault::kInvalidArgument,
              "the margins of " + std::to_string(problem.size()) +
                  " charts alone take more than the pages have: raise the resolution or the number "
                  "of pages, or lower the margin");
}

/// A generator of numbers (Steele, Lea and Flood 2014): the same everywhere.
class RandomNumbers {
 public:
  /// In [0, count).
  std::size_t below(std::size_t count) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>((z ^ z >> 31) % count);
  }

 private:
  std::uint64_t state_ = 0;
};

/// Layouts on one page: at one density in a room that is larger than the page, by which the next
/// density is chosen.
class OnePage {
 public:
  explicit OnePage(const Problem& problem)
      : problem_(problem),
        cells_(problem.cells()),
        strip_(cells_, static_cast<int>(kStrip * cells_)),
        first_{problem.order(), std::vector<int>(problem.size(), kNone)} {}

  Packed run() {
    start();
    improve();
    return std::move(best_);
  }

 private:
  /// Less is better: the cells per side that the page must have, then how high charts lie.
  struct Cost {
    int side = 0;
    std::int64_t tops = 0;
    auto operator<=>(const Cost&) const = default;
  };

  /// A plan that takes more than `limit` cells fails: the sooner, the less it costs.
  Layout lay(const Plan& plan, Rule rule, int limit = kNoLimit) {
    if (rule == Rule::kCorner && !square_) {
      square_.emplace(strip_.height(), strip_.height());
    }
    const bool lowest = rule == Rule::kLowest;
    Layout layout = place_in_order(masks_, plan, rule, {}, lowest ? strip_ : *square_, 1,
                                   lowest ? spare_strip_ : spare_square_, limit);
    steps_ += layout.steps;
    return layout;
  }

  Cost cost(const Layout& layout) const {
    if (layout.failed != kNone) return {static_cast<int>(kStrip * cells_) + 1, 0};
    Cost cost{std::max(layout.width, layout.height), 0};
    for (std::size_t c = 0; c < masks_.size(); ++c) {
      if (masks_[c].empty()) continue;
      const Mask& mask = masks_[c][layout.spots[c].turn];
      cost.tops += static_cast<std::int64_t>(layout.spots[c].y + mask.height) * mask.cells;
    }
    return cost;
  }

  void set_density(double density) {
    density_ = density;
    masks_ = problem_.masks(density);
    steps_ += Problem::steps_of(masks_);
  }

  void keep(const Layout& layout) {
    if (density_ <= best_.texels_per_unit) return;
    best_ = {problem_.placements(masks_, layout), density_};
  }

  /// The density at which a layout of a strip would be as high as the page: of many charts the
  /// area tells.
  double fitting(const Layout& layout) const {
    return density_ * std::sqrt(cells_ / std::max<double>(layout.height, 1));
  }

  /// Finds a density at which the first order fits, and is nearly full.
  void start() {
    constexpr double kEnough = 0.985;  // of the side
    constexpr int kMostTries = 12;
    constexpr double kSame = 1.01;    // of densities: further tries gain no more
    constexpr double kBelow = 0.998;  // of the estimate, which is for charts without corners
    Bracket fitting_density;
    set_density(problem_.density_for(kFirstShare));
    for (int tries = 0;; ++tries) {
      const Layout layout = lay(first_, Rule::kLowest);
      const bool whole = layout.failed == kNone;
      const bool fits = whole && layout.height <= cells_;
      if (fits) keep(layout);
      fitting_density.note(density_, !fits);
      if (fits && (layout.height >= kEnough * cells_ || tries >= kMostTries)) return;
      if (fitting_density.is_within(kSame)) return;
      if (tries > kMostStepsDown) refuse_margins(problem_);
      set_density(fitting_density.inside(whole ? kBelow * fitting(layout) : kStepDown * density_));
    }
  }

  /// Tries orders near the best, at a density at which that does not fit yet.
  void improve() {
    const auto budget = static_cast<std::int64_t>(kSteps * problem_.options().effort);
    if (budget <= 0) return;
    RandomNumbers random;
    Rule rule = Rule::kLowest;
    raise_density();
    Plan plan = first_;
    Cost current = cost(lay(plan, rule));
    if (const Cost other = cost(lay(plan, Rule::kCorner)); other < current) {
      rule = Rule::kCorner;
      current = other;
    }
    // Few charts have few plans.
    const auto count = static_cast<std::int64_t>(plan.order.size());
    const std::int64_t most_misses = kPlansOfFew + 4 * count * count;
    for (std::int64_t misses = 0; misses < most_misses; ++misses) {
      if (steps_ >= budget || count < 2 || problem_.work().out_of_time()) return;
      Plan tried = plan;
      const Rule rule_tried = change(random, tried) ? rule : other_of(rule);
      const Layout layout = lay(tried, rule_tried, current.side);
      const Cost found = cost(layout);
      if (current < found) continue;
      if (found < current) misses = 0;
      plan = std::move(tried);
      rule = rule_tried;
      current = found;
      if (found.side <= cells_) {
        keep(layout);
        raise_density();
        current = cost(lay(plan, rule));
      }
    }
  }

  static Rule other_of(Rule rule) { return rule == Rule::kLowest ? Rule::kCorner : Rule::kLowest; }

  void raise_density() {
    constexpr double kRaise = 1.006;
    set_density(kRaise * best_.texels_per_unit);
  }

  /// Takes a chart to another place of the order, changes two, or says how one is turned. Returns
  /// false where the rule is to change instead.
  bool change(RandomNumbers& random, Plan& plan) const {
    std::vector<Index>& order = plan.order;
    const std::size_t from = random.below(order.size()), to = random.below(order.size());
    // Of sixteen changes one is of the rule, five swap two charts, five take one elsewhere, two
    // leave the turn of one open, and three say it.
    const std::size_t kind = random.below(16);
    if (kind == 0) return false;
    if (kind < 6) {
      std::swap(order[from], order[to]);
    } else if (kind < 11) {
      const auto first = order.begin() + static_cast<std::ptrdiff_t>(std::min(from, to));
      const auto last = order.begin() + static_cast<std::ptrdiff_t>(std::max(from, to)) + 1;
      std::rotate(first, from > to ? last - 1 : first + 1, last);
    } else {
      // Mostly of the first charts, which are large.
      const Index chart = order[std::min(from, to)];
      const auto turns = static_cast<std::size_t>(problem_.turns());
      plan.turns[chart] = kind < 13 ? kNone : static_cast<int>(random.below(turns));
    }
    return true;
  }

  static constexpr std::int64_t kPlansOfFew = 100;

  const Problem& problem_;
  int cells_;
  Page strip_;
  std::optional<Page> square_;
  std::vector<Page> spare_strip_, spare_square_;
  Plan first_;
  double density_ = 0;
  Masks masks_;
  std::int64_t steps_ = 0;
  Packed best_;
};

/// Several pages: each is full before the next is begun, so that only fits and does not tell.
Packed pack_on_pages(const Problem& problem) {
  constexpr double kEnough = 1.005;
  const Page empty(problem.cells(), problem.cells());
  const Plan plan{problem.order(), {}};
  std::vector<Page> spare;
  double density = problem.density_for(kFirstShare);
  Bracket fitting_density;
  Packed best;
  for (int step = 0; step < kMostStepsDown; ++step) {
    const Masks masks = problem.masks(density);
    const Layout layout =
        place_in_order(masks, plan, Rule::kLowest, {}, empty, problem.options().max_pages, spare);
    if (layout.failed == kNone) {
      best = {problem.placements(masks, layout), density};
    }
    fitting_density.note(density, layout.failed != kNone);
    if (fitting_density.is_within(kEnough)) break;
    if (fitting_density.is_closed()) {
      density = fitting_density.middle();
    } else {
      density *= fitting_density.has_low() ? kStepUp : kStepDown;
    }
  }
  if (!fitting_density.has_low()) refuse_margins(problem);
  return best;
}

}  // namespace

Packed pack_at_largest(const Problem& problem) {
  const double side = problem.options().resolution + 2 * problem.radius();
  const double disks = problem.size() * std::numbers::pi * problem.radius() * problem.radius();
  if (disks > kDensestDisks * problem.options().max_pages * side * side) refuse_margins(problem);
  if (problem.options().max_pages > 1) {
    Packed packed = pack_on_pages(problem);
    return problem.few_to_order() ? grow(problem, std::move(packed)) : packed;
  }
  if (problem.few_to_order()) return grow(problem, OnePage(problem).run());
  Packed packed = pack_many(problem);
  if (!(packed.texels_per_unit > 0)) refuse_margins(problem);
  return packed;
}

Packed pack_at_density(const Problem& problem, double density) {
  const Page empty(problem.cells(), problem.cells());
  const Plan plan{problem.order(), {}};
  std::vector<Page> spare;
  Index failed = kNone;
  const auto lay = [&](const Masks& masks, Rule rule) {
    Layout layout = place_in_order(masks, plan, rule, problem.kept_pages(density), empty,
                                   problem.options().max_pages, spare);
    if (failed == kNone) failed = layout.failed;
    return layout;
  };
  const Masks masks = problem.masks(density);
  for (const Rule rule : {Rule::kLowest, Rule::kCorner}) {
    const Layout layout = lay(masks, rule);
    if (layout.failed == kNone) return {problem.placements(masks, layout), density};
  }
  // Charts that fit at a lower density may grow to that asked for, and push one another aside.
  for (const double share : {0.98, 0.96, 0.94, 0.92}) {
    const Masks lower = problem.masks(share * density);
    const Layout layout = lay(lower, Rule::kLowest);
    if (layout.failed != kNone) continue;
    Packed grown = grow(problem, {problem.placements(lower, layout), share * density}, density);
    if (grown.texels_per_unit >= density) return grown;
  }
  throw Error(Fault::kInvalidArgument,
              "chart " + std::to_string(failed) +
                  " finds no room at these texels per unit: lower them, or raise the "
                  "resolution or the number of pages");
}

}  // namespace beltrami
