#include "pack/greedy.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// Of so many charts on, none looks at all rows.
constexpr std::size_t kManyCharts = 400;

/// What a row of a page or a mask costs beside the search, in steps.
constexpr std::int64_t kStepsPerRow = 100;

/// Charts are of about one size down to this share of the cells of the first.
constexpr double kSameSize = 0.8;

/// The rows below which recent charts of about this size have found no place.
class Floor {
 public:
  int row() const { return count_ < kRecent ? 0 : *std::min_element(rows_.begin(), rows_.end()); }
  void found(int row) { rows_[count_++ % kRecent] = row; }
  void reset() { count_ = 0; }

 private:
  static constexpr std::size_t kRecent = 6;
  std::array<int, kRecent> rows_{};
  std::size_t count_ = 0;
};

/// A place and what it is worth: less is better.
struct Candidate {
  int cost = kNoLimit + 1, second = 0;
  Spot spot;

  bool found() const { return spot.page != kNone; }
};

/// The best place of one mask by its upper side; rows that cannot be better are not looked at.
void look_lowest(const Page& page, const Mask& mask, int from, Spot spot, std::int64_t& steps,
                 Candidate& best) {
  const int last = std::min(page.height(), best.cost) - mask.height;
  const int furthest = page.width() - mask.width;
  Page::Places places;
  for (int y = from; y <= last;) {
    y = page.skip_full_rows(mask, y, last, furthest, steps);
    if (y > last) return;
    const int rows = Page::rows_together(mask, y, last);
    if (!page.first_free(mask, y, rows, furthest, places, steps)) {
      y += rows;
      continue;
    }
    int k = 0;
    while (places[k] < 0) ++k;
    const int cost = y + k + mask.height, second = places[k] + mask.width;
    if (cost < best.cost || second < best.second) {
      spot.x = places[k];
      spot.y = y + k;
      best = {cost, second, spot};
    }
    return;
  }
}

/// Likewise by the greater of its upper and its right side.
void look_corner(const Page& page, const Mask& mask, int from, Spot spot, std::int64_t& steps,
                 Candidate& best) {
  Page::Places places;
  for (int y = from;;) {
    const int last = std::min(page.height(), best.cost) - mask.height;
    const int furthest = std::min(page.width(), best.cost) - mask.width;
    if (y > last || furthest < 0) return;
    y = page.skip_full_rows(mask, y, last, furthest, steps);
    if (y > last) return;
    const int rows = Page::rows_together(mask, y, last);
    if (page.first_free(mask, y, rows, furthest, places, steps)) {
      for (int k = 0; k < rows; ++k) {
        const int up = y + k + mask.height, right = places[k] + mask.width;
        const int cost = std::max(up, right), second = std::min(up, right);
        if (places[k] < 0 || cost > best.cost) continue;
        if (cost < best.cost || second < best.second) {
          spot.x = places[k];
          spot.y = y + k;
          best = {cost, second, spot};
        }
      }
    }
    y += rows;
  }
}

Candidate best_place(const Page& page, const std::vector<Mask>& masks, Index index, Rule rule,
                     int from, int forced, int limit, std::int64_t& steps) {
  Candidate best;
  best.cost = limit + 1;
  for (int turn = 0; turn < static_cast<int>(masks.size()); ++turn) {
    if (forced != kNone && turn != forced) continue;
    const Mask& mask = masks[turn];
    if (mask.width > page.width() || mask.height > page.height()) continue;
    if (mask.cells > page.free_cells()) continue;
    const Spot spot{index, turn, 0, 0};
    if (rule == Rule::kLowest) {
      look_lowest(page, mask, from, spot, steps, best);
    } else {
      look_corner(page, mask, from, spot, steps, best);
    }
  }
  return best;
}

/// Per chart of an order what the masks of those after it ask of a page; first what all do.
std::vector<Needs> later_needs(const std::vector<std::vector<Mask>>& masks,
                               const std::vector<Index>& order) {
  std::vector<Needs> later(order.size() + 1);
  Needs needs{0, 0};
  later.back() = needs;
  for (std::size_t i = order.size(); i-- > 0;) {
    for (const Mask& mask : masks[order[i]]) {
      needs.run_level = std::max(needs.run_level, mask.needs.run_level);
      needs.square_level = std::max(needs.square_level, mask.needs.square_level);
    }
    later[i] = needs;
  }
  return later;
}

/// The pages of a layout; those that were added are spare in the end.
class Pages {
 public:
  Pages(std::vector<Page> given, const Page& empty, std::vector<Page>& spare)
      : empty_(empty), spare_(spare), given_(given.size()), pages_(std::move(given)) {}
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  ~Pages() {
    for (; pages_.size() > given_; pages_.pop_back()) spare_.push_back(std::move(pages_.back()));
  }

  Page& operator[](Index p) { return pages_[p]; }
  Index size() const { return size_of(pages_); }
  void add(const Needs& needs) {
    // The destructor is to allocate nothing.
    spare_.reserve(spare_.size() + pages_.size() - given_ + 1);
    if (spare_.empty()) {
      pages_.emplace_back(empty_, needs);
      return;
    }
    pages_.push_back(std::move(spare_.back()));
    spare_.pop_back();
    pages_.back().assign(empty_, needs);
  }

 private:
  const Page& empty_;
  std::vector<Page>& spare_;
  std::size_t given_;
  std::vector<Page> pages_;
};

}  // namespace

Layout place_in_order(const std::vector<std::vector<Mask>>& masks, const Plan& plan, Rule rule,
                      std::vector<Page> given, const Page& empty, int max_pages,
                      std::vector<Page>& spare, int limit) {
  Layout layout;
  Pages pages(std::move(given), empty, spare);
  layout.steps = empty.height() * kStepsPerRow;
  layout.spots.resize(masks.size());
  const bool many = plan.order.size() >= kManyCharts;
  std::vector<Floor> floors(static_cast<std::size_t>(pages.size()));
  double size = 0;  // of the charts that the floors are about
  const std::vector<Needs> later = later_needs(masks, plan.order);
  for (std::size_t i = 0; i < plan.order.size(); ++i) {
    const Index chart = plan.order[i];
    poll_interrupt();
    Spot& spot = layout.spots[chart];
    if (masks[chart].empty() || masks[chart][0].cells == 0) {
      spot.page = 0;
      continue;
    }
    const auto cells = static_cast<double>(masks[chart][0].cells);
    if (cells < kSameSize * size || size == 0) {
      size = cells;
      for (Floor& floor : floors) floor.reset();
    }
    for (Index p = 0; p < max_pages && spot.page == kNone; ++p) {
      poll_interrupt();
      if (p == pages.size()) {
        pages.add(later[i]);
        floors.emplace_back();
      }
      const int forced = plan.turns.empty() ? kNone : plan.turns[chart];
      const int from = many ? floors[p].row() : 0;
      const bool was_empty = pages[p].empty();
      spot = best_place(pages[p], masks[chart], p, rule, from, forced, limit, layout.steps).spot;
      floors[p].found(spot.page == kNone ? pages[p].height() : spot.y);
      if (was_empty && spot.page == kNone) break;  // it is too large for any page
    }
    if (spot.page == kNone) {
      layout.failed = chart;
      return layout;
    }
    const Mask& mask = masks[chart][spot.turn];
    pages[spot.page].take(mask, spot.x, spot.y, later[i + 1]);
    layout.steps += mask.height * kStepsPerRow;
    layout.width = std::max(layout.width, spot.x + mask.width);
    layout.height = std::max(layout.height, spot.y + mask.height);
  }
  return layout;
}

}  // namespace beltrami
