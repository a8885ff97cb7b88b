#include "pack/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/vectors.h"
#include "pack/mask.h"
#include "pack/outline.h"
#include "pack/types.h"

namespace beltrami {
namespace {

/// A triangle of the size given, as it lies.
Mask triangle(double width, double height, double radius) {
  const PackChart chart{{{0, 0}, {width, height / 3}, {width / 2, height}}, {{0, 1, 2}}};
  return mask_of(outline_of(chart), Vec2(1, 0), 1, radius, 1000);
}

/// Cells one by one, to compare with.
class Cells {
 public:
  Cells(int width, int height) : width_(width), height_(height), taken_(width * height, 0) {}

  bool is_free(const Mask& mask, int x, int y) const {
    for (const Run& run : mask.runs) {
      for (int k = run.begin; k < run.end; ++k) {
        if (taken_[(y + run.row) * width_ + x + k] != 0) return false;
      }
    }
    return true;
  }
  int first_free(const Mask& mask, int y) const {
    for (int x = 0; x + mask.width <= width_; ++x) {
      if (is_free(mask, x, y)) return x;
    }
    return -1;
  }
  void take(const Mask& mask, int x, int y) {
    for (const Run& run : mask.runs) {
      for (int k = run.begin; k < run.end; ++k) taken_[(y + run.row) * width_ + x + k] = 1;
    }
  }
  std::int64_t free_cells() const { return std::count(taken_.begin(), taken_.end(), 0); }
  int height() const { return height_; }

 private:
  int width_, height_;
  std::vector<char> taken_;
};

/// Numbers that are the same everywhere.
class Numbers {
 public:
  int below(std::uint32_t count) {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<int>((state_ >> 8) % count);
  }

 private:
  std::uint32_t state_ = 7;
};

/// The first place in a row of the page, which is looked at together with those after it.
int first_free(const Page& page, const Mask& mask, int y, int to, std::int64_t& steps) {
  const int last = page.height() - mask.height;
  const int rows = std::min(Page::kRows, last - y + 1);
  Page::Places places;
  const bool found = page.first_free(mask, y, rows, to, places, steps);
  int first = -1;
  for (int k = rows; k-- > 0;) {
    Page::Places alone;
    const bool any = page.first_free(mask, y + k, 1, to, alone, steps);
    EXPECT_EQ(any, found && places[k] >= 0);
    first = any ? alone[0] : -1;
    if (any) {
      EXPECT_EQ(places[k], alone[0]);
    }
  }
  return first;
}

/// Fills a page with triangles up to a size, each at the first place that cells one by one find.
void expect_places_of_cells(Page page, Numbers& numbers, int rounds, std::uint32_t size) {
  Cells cells(page.width(), page.height());
  std::int64_t steps = 0;
  for (int round = 0; round < rounds; ++round) {
    const double width = 1 + numbers.below(size), height = 1 + numbers.below(30);
    const Mask mask = triangle(width, height, 0.3 * numbers.below(5));
    ASSERT_LE(mask.height, page.height());
    const int last = page.height() - mask.height, to = page.width() - mask.width;
    int found = -1, row = -1;
    for (int y = 0; y <= last; ++y) {
      const int x = first_free(page, mask, y, to, steps);
      ASSERT_EQ(x, cells.first_free(mask, y));
      if (x >= 0 && found < 0) {
        found = x;
        row = y;
      }
    }
    // What is skipped has no place.
    for (int y = 0; y <= last; ++y) {
      const int next = page.skip_full_rows(mask, y, last, to, steps);
      for (; y < std::min(next, last + 1); ++y) ASSERT_EQ(cells.first_free(mask, y), -1);
    }
    if (found < 0) continue;
    page.take(mask, found, row);
    cells.take(mask, found, row);
    ASSERT_EQ(page.free_cells(), cells.free_cells());
  }
  EXPECT_GT(steps, 0);
}

TEST(Page, FindsTheFirstPlaceThatCellsOneByOneFind) {
  // Parts of a row are 1, 4, 64 and 128 cells here.
  const std::vector<int> widths{60, 150, 4096, 4500};
  Numbers numbers;
  for (const int width : widths) {
    SCOPED_TRACE(width);
    expect_places_of_cells(Page(width, 90), numbers, 60, 40);
    expect_places_of_cells(Page(width, 90, false), numbers, 60, 40);
  }
  expect_places_of_cells(Page(4500, 40), numbers, 80, 900);
}

TEST(Page, ForSmallMasksIsSmallerAndTheSame) {
  Page page(300, 80);
  page.take(triangle(70, 50, 1), 40, 3);
  const Mask largest = triangle(12, 9, 1), small = triangle(5, 4, 1);
  Page copy(page, largest.needs);
  EXPECT_EQ(copy.free_cells(), page.free_cells());
  std::int64_t steps = 0;
  const auto expect_same = [&](const Mask& mask) {
    for (int y = 0; y + mask.height <= page.height(); ++y) {
      const int to = page.width() - mask.width;
      EXPECT_EQ(first_free(copy, mask, y, to, steps), first_free(page, mask, y, to, steps));
    }
  };
  expect_same(largest);
  const int x = first_free(page, largest, 5, page.width() - largest.width, steps);
  page.take(largest, x, 5);
  copy.take(largest, x, 5, small.needs);  // from now on for the small one alone
  expect_same(small);
}

/// That a mask of the frame below, turned so, has the cells that it is to have.
void expect_near_cells(const Mask& mask, const Vec2& turn, double radius) {
  std::vector<std::vector<bool>> taken(mask.height, std::vector<bool>(mask.width, false));
  for (const beltrami::Run& run : mask.runs) {
    for (int x = run.begin; x < run.end; ++x) taken[run.row][x] = true;
  }
  // Points of the chart and about it, in the cells that they are in.
  for (double u = -3; u < 33; u += 0.37) {
    for (double v = -3; v < 33; v += 0.37) {
      // Distance to the frame: outside of the outer square, or in the hole from its sides.
      const double outside = Vec2(std::max({-u, u - 30, 0.0}), std::max({-v, v - 30, 0.0})).norm();
      const double inside = std::min({u - 10, 20 - u, v - 10, 20 - v});
      const double distance = std::max(outside, inside);
      const Vec2 p = mask.origin + Vec2(turn.x() * u - turn.y() * v, turn.y() * u + turn.x() * v);
      const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
      const bool in = x >= 0 && y >= 0 && x < mask.width && y < mask.height && taken[y][x];
      const bool near = distance<radius, far = distance> radius + 1.5;  // a cell's diagonal
      EXPECT_FALSE(near && !in) << u << " " << v;
      EXPECT_FALSE(far && in) << u << " " << v;
    }
  }
}

TEST(Mask, HasTheCellsThatAreNearerThanTheRadius) {
  const double radius = 1.7;
  const PackChart frame{
      {{0, 0}, {30, 0}, {30, 30}, {0, 30}, {10, 10}, {20, 10}, {20, 20}, {10, 20}},
      {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}};
  const Outline outline = outline_of(frame);
  EXPECT_DOUBLE_EQ(outline.area, 800);
  const Mask mask = mask_of(outline, Vec2(0.8, 0.6), 1, radius, 1000);
  Vec2 turn(0.8, 0.6);
  expect_near_cells(mask, turn, radius);
  Mask turned = mask;
  for (int quarters = 1; quarters < 4; ++quarters) {
    turned = quarter_turned(turned);
    turn = {-turn.y(), turn.x()};
    EXPECT_EQ(turned.cells, mask.cells);
    EXPECT_EQ(turned.probes.size(), turned.runs.size());
    expect_near_cells(turned, turn, radius);
  }
}

TEST(Mask, TurnedByHalfIsTurnedTwiceByAQuarter) {
  const Mask mask = triangle(70, 45, 1.2);
  const Mask half = half_turned(mask), quarters = quarter_turned(quarter_turned(mask));
  ASSERT_EQ(half.runs.size(), quarters.runs.size());
  for (std::size_t r = 0; r < half.runs.size(); ++r) {
    EXPECT_EQ(half.runs[r].row, quarters.runs[r].row);
    EXPECT_EQ(half.runs[r].begin, quarters.runs[r].begin);
    EXPECT_EQ(half.runs[r].end, quarters.runs[r].end);
  }
  EXPECT_LT((half.origin - quarters.origin).norm(), 1e-9);
  // What is tested is what is taken.
  for (const Square& square : half.squares) {
    for (int y = square.y; y < square.y + (1 << square.level); ++y) {
      EXPECT_TRUE(std::any_of(half.runs.begin(), half.runs.end(), [&](const beltrami::Run& run) {
        return run.row == y && run.begin <= square.x && square.x + (1 << square.level) <= run.end;
      }));
    }
  }
  for (const Probe& probe : half.probes) {
    EXPECT_TRUE(std::any_of(half.runs.begin(), half.runs.end(), [&](const beltrami::Run& run) {
      return run.row == probe.row && run.begin == probe.left &&
             run.end == probe.right + (1 << probe.level);
    }));
  }
}

}  // namespace
}  // namespace beltrami
