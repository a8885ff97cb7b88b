#include "pack/pack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "pack/clearance.h"
#include "pack/outline.h"

namespace beltrami {
namespace {

PackChart rectangle(double width, double height) {
  return {{{0, 0}, {width, 0}, {width, height}, {0, height}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A frame of four bars around a square hole.
PackChart frame(double outer, double inner) {
  const double a = (outer - inner) / 2, b = (outer + inner) / 2;
  PackChart chart{{{0, 0}, {outer, 0}, {outer, outer}, {0, outer}, {a, a}, {b, a}, {b, b}, {a, b}},
                  {}};
  for (Index k = 0; k < 4; ++k) {
    const Index next = (k + 1) % 4;
    chart.faces.push_back({k, next, 4 + next});
    chart.faces.push_back({k, 4 + next, 4 + k});
  }
  return chart;
}

/// Fans of triangles about a middle, of sizes that differ much.
std::vector<PackChart> shards(int count) {
  std::vector<PackChart> charts;
  std::uint32_t state = 1;
  const auto number = [&] {  // in [0, 1)
    state = state * 1664525u + 1013904223u;
    return (state >> 8) * 0x1p-24;
  };
  for (int i = 0; i < count; ++i) {
    const double size = 0.1 + std::pow(number(), 3);
    PackChart chart;
    chart.points.emplace_back(3, -7);
    const std::vector<Vec2> star{{1, 0}, {0.4, 0.7}, {-0.5, 0.8}, {-0.9, -0.2}, {0.1, -0.6}};
    for (const Vec2& p : star) {
      chart.points.emplace_back(Vec2(3, -7) + size * (0.4 + 0.6 * number()) * p);
    }
    for (Index k = 0; k < 5; ++k) chart.faces.push_back({0, 1 + k, 1 + (k + 1) % 5});
    charts.push_back(std::move(chart));
  }
  return charts;
}

/// The places that a caller delivers: divided by the resolution and rounded to single precision.
std::vector<PlacedOutline> delivered(const std::vector<PackChart>& charts,
                                     const PackOptions& options, const Packing& packing) {
  std::vector<PlacedOutline> placed;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    PlacedOutline outline = beltrami::placed(outline_of(charts[c]), packing.placements[c],
                                             packing.texels_per_unit * charts[c].scale);
    for (Vec2& p : outline.points) {
      const Eigen::Vector2f single = (p / options.resolution).cast<float>();
      p = single.cast<double>() * options.resolution;
    }
    placed.push_back(std::move(outline));
  }
  return placed;
}

void expect_sound(const std::vector<PackChart>& charts, const PackOptions& options,
                  const Packing& packing) {
  ASSERT_EQ(packing.placements.size(), charts.size());
  const Clearance least = clearance(delivered(charts, options, packing), options.resolution,
                                    std::max(options.margin, 0.25));
  EXPECT_GE(least.charts, options.margin);
  EXPECT_GE(least.page, options.margin / 2);
  EXPECT_GE(packing.pages, 1);
  EXPECT_LE(packing.pages, options.max_pages);
  double area = 0;
  std::vector<bool> used(packing.pages, false);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const Placement& placement = packing.placements[c];
    EXPECT_NEAR(placement.turn.norm(), 1, 1e-15);
    ASSERT_GE(placement.page, 0);
    ASSERT_LT(placement.page, packing.pages);
    used[placement.page] = true;
    const double side = packing.texels_per_unit * charts[c].scale / options.resolution;
    area += outline_of(charts[c]).area * side * side;
  }
  EXPECT_TRUE(std::all_of(used.begin(), used.end(), [](bool is) { return is; }));
  EXPECT_NEAR(packing.utilisation, area / packing.pages, 1e-9);
}

void expect_same(const Packing& one, const Packing& other) {
  EXPECT_EQ(one.texels_per_unit, other.texels_per_unit);
  ASSERT_EQ(one.placements.size(), other.placements.size());
  for (std::size_t c = 0; c < one.placements.size(); ++c) {
    EXPECT_EQ(one.placements[c].page, other.placements[c].page);
    EXPECT_EQ(one.placements[c].turn, other.placements[c].turn);
    EXPECT_EQ(one.placements[c].offset, other.placements[c].offset);
  }
}

TEST(Pack, MarginsHoldInTheNumbersThatAreDelivered) {
  for (const int count : {1, 2, 7, 40}) {
    for (const double margin : {0.0, 0.5, 2.0, 9.0}) {
      PackOptions options;
      options.margin = margin;
      options.effort = 0.1;
      const std::vector<PackChart> charts = shards(count);
      const Packing packing = pack_charts(charts, options, Work());
      SCOPED_TRACE(count);
      expect_sound(charts, options, packing);
    }
  }
}

TEST(Pack, ManyChartsKeepTheirMargins) {
  const std::vector<PackChart> charts = shards(1500);
  const PackOptions options;
  expect_sound(charts, options, pack_charts(charts, options, Work()));
}

TEST(Pack, ManyTinyChartsLieAsNearAsTheirMarginsAllow) {
  // Squares of some texels: a grid of texels would leave half a one more around each.
  const std::vector<PackChart> charts(2000, rectangle(1, 1));
  PackOptions options;
  options.turns = 4;
  options.resolution = 256;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  // 45 to a row: 256 / 45 is 5.68, of which the margin takes 2.
  EXPECT_GT(packing.texels_per_unit, 0.9 * 3.68);
}

TEST(Pack, TheSameBitsAtAnyNumberOfThreads) {
  for (const int count : {12, 700, 2500}) {
    PackOptions options;
    options.effort = 0.1;
    const std::vector<PackChart> charts = shards(count);
    expect_same(pack_charts(charts, options, Work(1)), pack_charts(charts, options, Work(2)));
  }
}

TEST(Pack, ASquareFillsThePage) {
  const std::vector<PackChart> charts{rectangle(3, 3)};
  PackOptions options;
  options.margin = 2;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  EXPECT_GT(packing.utilisation, 0.99);
}

TEST(Pack, ChartsLieInTheHolesOfOthers) {
  const std::vector<PackChart> charts{frame(10, 7), rectangle(6, 6)};
  const PackOptions options;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  EXPECT_GT(packing.utilisation, 0.8);  // beside the frame there would be room for half of it
}

TEST(Pack, TheSizeOfTheInputDoesNotCount) {
  std::vector<PackChart> charts = shards(9);
  PackOptions options;
  options.effort = 0.1;
  const Packing packing = pack_charts(charts, options, Work());
  for (PackChart& chart : charts) {
    for (Vec2& p : chart.points) p *= 1024;
  }
  const Packing larger = pack_charts(charts, options, Work());
  EXPECT_EQ(larger.utilisation, packing.utilisation);
  EXPECT_EQ(larger.texels_per_unit * 1024, packing.texels_per_unit);
}

TEST(Pack, ScalesAreThoseOfTheCharts) {
  // One chart at twice the density of its like is placed as one of twice its size.
  std::vector<PackChart> scaled{rectangle(2, 1), rectangle(1, 1)};
  scaled[1].scale = 2;
  const PackOptions options;
  const Packing packing = pack_charts(scaled, options, Work());
  expect_sound(scaled, options, packing);
  const std::vector<PackChart> larger{rectangle(2, 1), rectangle(2, 2)};
  EXPECT_NEAR(packing.texels_per_unit, pack_charts(larger, options, Work()).texels_per_unit,
              1e-6 * packing.texels_per_unit);
}

TEST(Pack, QuarterTurnsAloneWhereTheyAreAskedFor) {
  const std::vector<PackChart> charts = shards(20);
  PackOptions options;
  options.effort = 0.1;
  for (const int turns : {1, 4}) {
    options.turns = turns;
    const Packing packing = pack_charts(charts, options, Work());
    expect_sound(charts, options, packing);
    for (const Placement& placement : packing.placements) {
      EXPECT_EQ(placement.turn.cwiseAbs().minCoeff(), 0);
      if (turns == 1) {
        EXPECT_EQ(placement.turn, Vec2(1, 0));
      }
    }
  }
}

TEST(Pack, AGivenDensityTakesThePagesThatItNeeds) {
  const std::vector<PackChart> charts(10, rectangle(1, 1));
  PackOptions options;
  options.resolution = 256;
  options.texels_per_unit = 120;  // four to a page
  options.max_pages = 1000;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  EXPECT_EQ(packing.pages, 3);
  EXPECT_EQ(packing.texels_per_unit, 120);
  options.max_pages = 2;
  EXPECT_THROW(pack_charts(charts, options, Work()), Error);
}

TEST(Pack, SeveralPagesAreFilledAtOneDensity) {
  const std::vector<PackChart> charts = shards(30);
  PackOptions options;
  options.effort = 0.1;
  const Packing one = pack_charts(charts, options, Work());
  options.max_pages = 3;
  const Packing three = pack_charts(charts, options, Work());
  expect_sound(charts, options, three);
  EXPECT_EQ(three.pages, 3);
  EXPECT_GT(three.texels_per_unit, 1.4 * one.texels_per_unit);
}

TEST(Pack, GroupsShareNoPageAndHaveOneDensity) {
  std::vector<PackChart> charts = shards(30);
  for (std::size_t c = 0; c < charts.size(); ++c) charts[c].group = c % 5 == 0 ? 7 : c % 2;
  PackOptions options;
  options.effort = 0.1;
  const Packing packing = pack_charts(charts, options, Work());
  EXPECT_EQ(packing.pages, 3) << "one for each";
  for (std::size_t c = 0; c < charts.size(); ++c) {
    EXPECT_EQ(packing.placements[c].page, charts[c].group == 7 ? 2 : static_cast<int>(c % 2));
  }
  // The greatest density at which each of them fits by itself.
  double least = HUGE_VAL;
  for (const std::uint64_t group : {0, 1, 7}) {
    std::vector<PackChart> own;
    for (const PackChart& chart : charts) {
      if (chart.group == group) own.push_back(chart);
    }
    least = std::min(least, pack_charts(own, options, Work()).texels_per_unit);
  }
  EXPECT_LE(packing.texels_per_unit, least);
  EXPECT_GE(packing.texels_per_unit, 0.97 * least);
  expect_same(packing, pack_charts(charts, options, Work(2)));
  options.texels_per_unit = 1.2 * least;
  options.max_pages = 9;
  const Packing denser = pack_charts(charts, options, Work());
  EXPECT_GT(denser.pages, 3);
  EXPECT_EQ(denser.texels_per_unit, options.texels_per_unit);
  options.max_pages = denser.pages;
  expect_sound(charts, options, denser);
  std::vector<PackChart> many(1001, rectangle(1, 1));
  for (std::size_t c = 0; c < many.size(); ++c) many[c].group = c;
  options.texels_per_unit = 1;
  EXPECT_THROW(pack_charts(many, options, Work()), Error) << "UDIM has a thousand";
}

TEST(Pack, ChartsThatAreKeptStay) {
  std::vector<PackChart> charts = shards(25);
  PackOptions options;
  options.effort = 0.1;
  const Packing before = pack_charts(charts, options, Work());
  options.texels_per_unit = before.texels_per_unit;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (c != 3 && c != 11) charts[c].kept = before.placements[c];
  }
  for (Vec2& p : charts[3].points) p = Vec2(3, -7) + 0.5 * (p - Vec2(3, -7));
  charts[11].points = charts[3].points;
  const Packing after = pack_charts(charts, options, Work());
  expect_sound(charts, options, after);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (!charts[c].kept) continue;
    EXPECT_EQ(after.placements[c].turn, before.placements[c].turn);
    EXPECT_EQ(after.placements[c].offset, before.placements[c].offset);
  }
}

/// Nine squares on a page of 1,024 texels, as large as their margins allow but for half a texel
/// each, of which the cells of the grid, two texels, take more; and the place of the first.
struct NineSquares {
  std::vector<PackChart> charts = std::vector<PackChart>(9, rectangle(1, 1));
  PackOptions options;
  Placement first{0, Vec2(1, 0), Vec2(1.01, 1.01)};

  NineSquares() {
    options.turns = 1;
    options.texels_per_unit = 338.8;
  }
};

TEST(Pack, ChartsGrowToTheDensityThatIsAskedFor) {
  NineSquares nine;
  const Packing packing = pack_charts(nine.charts, nine.options, Work());
  expect_sound(nine.charts, nine.options, packing);
  EXPECT_EQ(packing.texels_per_unit, nine.options.texels_per_unit);
  nine.options.effort = 0;  // without growth
  EXPECT_THROW(pack_charts(nine.charts, nine.options, Work()), Error);
}

TEST(Pack, ChartsGrowBesideThoseThatStay) {
  NineSquares nine;
  nine.charts[0].kept = nine.first;
  const Packing packing = pack_charts(nine.charts, nine.options, Work());
  expect_sound(nine.charts, nine.options, packing);
  EXPECT_EQ(packing.placements[0].offset, nine.first.offset);
  EXPECT_EQ(packing.placements[0].turn, nine.first.turn);
  EXPECT_EQ(packing.texels_per_unit, nine.options.texels_per_unit);
  nine.options.effort = 0;
  EXPECT_THROW(pack_charts(nine.charts, nine.options, Work()), Error);
}

TEST(Pack, ChartsThatStayMayLieOnEachOtherAndBeyondThePage) {
  NineSquares nine;
  nine.charts[0].kept = nine.first;
  nine.charts.push_back(nine.charts[0]);
  nine.charts.back().kept->offset = {-4, 1};
  const Packing packing = pack_charts(nine.charts, nine.options, Work());
  EXPECT_EQ(packing.placements.back().offset, nine.charts.back().kept->offset);
  EXPECT_EQ(packing.texels_per_unit, nine.options.texels_per_unit);
}

/// That nothing but a chart's own border, sampled densely, lies in its blocks.
void expect_blocks_of_one(const std::vector<PackChart>& charts, const PackOptions& options,
                          const Packing& packing) {
  const int count = options.resolution / options.block;
  std::vector<Index> owner(static_cast<std::size_t>(count) * count * packing.pages, kNone);
  const std::vector<PlacedOutline> placed = delivered(charts, options, packing);
  for (Index c = 0; c < size_of(placed); ++c) {
    for (const auto& [from, to] : placed[c].edges) {
      for (int k = 0; k <= 1000; ++k) {
        const Vec2 p =
            placed[c].points[from] + k / 1000.0 * (placed[c].points[to] - placed[c].points[from]);
        const int row = placed[c].page * count + static_cast<int>(p.y() / options.block);
        Index& block = owner[row * count + static_cast<int>(p.x() / options.block)];
        EXPECT_TRUE(block == kNone || block == c);
        block = c;
      }
    }
  }
}

TEST(Pack, BlocksAreOfOneChart) {
  const std::vector<PackChart> charts = shards(20);
  for (const int pages : {1, 2}) {
    PackOptions options;
    options.resolution = 256;
    options.block = 4;
    options.effort = 0.1;
    options.max_pages = pages;
    const Packing packing = pack_charts(charts, options, Work());
    expect_sound(charts, options, packing);
    expect_blocks_of_one(charts, options, packing);
    options.effort = 0;
    EXPECT_GE(packing.utilisation, pack_charts(charts, options, Work()).utilisation);
  }
}

TEST(Pack, ChartsGrowWithinTheirBlocks) {
  // Some blocks beside a square are free, but never one to each side of it.
  const std::vector<PackChart> charts{rectangle(1, 1), rectangle(1, 0.2)};
  PackOptions options;
  options.resolution = 256;
  options.block = 32;
  options.turns = 1;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  expect_blocks_of_one(charts, options, packing);
  // Six rows of blocks for the square and two for the bar: the square fills its rows.
  EXPECT_GT(packing.texels_per_unit, 6 * 32 - 2.3);
}

TEST(Pack, FoldedChartsCoverWhatTheirFacesDo) {
  // The second face is turned over and lies beside the first: signed areas would cancel.
  PackChart folded{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 3, 2}}};
  const Outline outline = outline_of(folded);
  EXPECT_DOUBLE_EQ(outline.area, 1);
  const std::vector<PackChart> charts{folded, rectangle(0.5, 0.5)};
  const PackOptions options;
  expect_sound(charts, options, pack_charts(charts, options, Work()));
}

TEST(Pack, ChartsWithoutAreaOrFacesAreNoFailure) {
  PackChart needle{{{0, 0}, {1, 0}, {2, 0}}, {{0, 1, 2}}};
  PackChart point{{{5, 5}, {5, 5}, {5, 5}}, {{0, 1, 2}}};
  PackChart empty;
  const std::vector<PackChart> charts{needle, point, empty, rectangle(1, 1)};
  const PackOptions options;
  const Packing packing = pack_charts(charts, options, Work());
  expect_sound(charts, options, packing);
  const std::vector<PackChart> alone{point, empty};
  expect_sound(alone, options, pack_charts(alone, options, Work()));
  EXPECT_EQ(pack_charts({}, options, Work()).pages, 0);
}

TEST(Pack, RefusesWhatCannotBe) {
  const std::vector<PackChart> charts = shards(200);
  const auto fault = [&](const PackOptions& options) {
    try {
      pack_charts(charts, options, Work());
    } catch (const Error& error) {
      return std::optional(error.fault());
    }
    return std::optional<Fault>();
  };
  PackOptions options;
  options.resolution = 16;  // 200 margins take 16 texels each
  options.margin = 4;
  EXPECT_EQ(fault(options), Fault::kInvalidArgument);
  for (const auto& change : std::vector<void (*)(PackOptions&)>{
           [](PackOptions& o) { o.resolution = 4; }, [](PackOptions& o) { o.margin = -1; },
           [](PackOptions& o) { o.turns = 7; }, [](PackOptions& o) { o.block = 0; },
           [](PackOptions& o) { o.max_pages = 0; }, [](PackOptions& o) { o.effort = NAN; },
           [](PackOptions& o) { o.texels_per_unit = 1e9; }}) {
    PackOptions wrong;
    change(wrong);
    EXPECT_EQ(fault(wrong), Fault::kInvalidArgument);
  }
}

}  // namespace
}  // namespace beltrami
