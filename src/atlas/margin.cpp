#include "atlas/margin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "atlas/pages.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "exact/uv_boundary.h"

namespace beltrami {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Texels within which other charts are sought at first, then twice as far until one is found.
constexpr double kFirstReach = 4;
/// Cells to the side of a page at most: more would be smaller than what charts are apart.
constexpr double kMostCells = 2048;
constexpr std::int64_t kGrain = 4096;

/// An edge at a boundary, in texels of its page.
struct Side {
  Vec2 a, b;
  Index chart, page;
};

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_segment(const Vec2& p, const Side& side) {
  const Vec2 along = side.b - side.a;
  const double length_sq = along.squaredNorm();
  const double t = length_sq > 0 ? std::clamp((p - side.a).dot(along) / length_sq, 0.0, 1.0) : 0;
  return (p - side.a - t * along).norm();
}

double distance(const Side& s, const Side& t) {
  const double a = cross(s.b - s.a, t.a - s.a), b = cross(s.b - s.a, t.b - s.a);
  const double c = cross(t.b - t.a, s.a - t.a), d = cross(t.b - t.a, s.b - t.a);
  if (((a > 0 && b < 0) || (a < 0 && b > 0)) && ((c > 0 && d < 0) || (c < 0 && d > 0))) return 0;
  return std::min({distance_to_segment(s.a, t), distance_to_segment(s.b, t),
                   distance_to_segment(t.a, s), distance_to_segment(t.b, s)});
}

std::vector<Side> sides_of(const PagedCharts& charts, const Work& work) {
  std::vector<std::int8_t> signs(charts.faces.size(), 0);
  for (std::size_t f = 0; f < signs.size(); ++f)
    signs[f] = charts.chart_of_face[f] == kNone ? 0 : 1;
  const SignedTriangles triangles{charts.faces, charts.uvs, std::move(signs)};
  const UvBoundary boundary = uv_boundary(triangles, work);
  std::vector<Side> sides;
  sides.reserve(boundary.edges.size());
  for (const UvEdge& edge : boundary.edges) {
    const Index chart = charts.chart_of_face[edge.face()], page = charts.page_of_chart[chart];
    const Vec2 tile = tile_of(page);
    sides.push_back({charts.resolution * (charts.uvs[edge.from] - tile),
                     charts.resolution * (charts.uvs[edge.to] - tile), chart, page});
  }
  return sides;
}

/// A cell of a page and a side that comes near it.
struct Entry {
  std::int64_t cell;
  Index side;
};

/// Every cell that has a point no further than `reach` / 2 from the side, and a few more: two sides
/// no further apart than `reach` have one in common.
void enter(const Side& side, Index number, double reach, double cell, std::int64_t cells,
           std::vector<Entry>& entries) {
  const auto at = [&](double x) {
    return std::clamp(static_cast<std::int64_t>(std::floor(x / cell)), std::int64_t{0}, cells - 1);
  };
  const double half = reach / 2;
  const double low = std::min(side.a.y(), side.b.y()), high = std::max(side.a.y(), side.b.y());
  const Vec2 along = side.b - side.a;
  for (std::int64_t row = at(low - half); row <= at(high + half); ++row) {
    // What of the side is within the reach of the row, but beyond the ends for the first and last.
    double from = 0, to = 1;
    if (along.y() != 0) {
      const double bottom = (static_cast<double>(row) * cell - half - side.a.y()) / along.y();
      const double top = (static_cast<double>(row + 1) * cell + half - side.a.y()) / along.y();
      from = std::clamp(std::min(bottom, top), 0.0, 1.0);
      to = std::clamp(std::max(bottom, top), 0.0, 1.0);
    }
    const double start = side.a.x() + from * along.x(), end = side.a.x() + to * along.x();
    const double left = std::min(start, end), right = std::max(start, end);
    for (std::int64_t column = at(left - half); column <= at(right + half); ++column) {
      entries.push_back({(side.page * cells + row) * cells + column, number});
    }
  }
}

bool compared(const PagedCharts& charts, const Side& s, const Side& t) {
  return s.chart != t.chart &&
         !(!charts.kept.empty() && charts.kept[s.chart] && charts.kept[t.chart]);
}

/// The least distance of sides of two charts, if that is no more than `reach`; else something more.
double least_within(const PagedCharts& charts, const std::vector<Side>& sides, double reach,
                    const Work& work) {
  const double cell = std::max(reach, charts.resolution / kMostCells);
  const auto cells = static_cast<std::int64_t>(std::floor(charts.resolution / cell)) + 1;
  std::vector<Entry> entries;
  PollSometimes poll;
  for (Index i = 0; i < size_of(sides); ++i) {
    poll();
    enter(sides[i], i, reach, cell, cells, entries);
  }
  sort_interruptibly(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.side < b.side;
  });
  const auto count = static_cast<std::int64_t>(entries.size());
  std::vector<double> least(static_cast<std::size_t>((count + kGrain - 1) / kGrain), kInfinity);
  parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    double& own = least[static_cast<std::size_t>(begin / kGrain)];
    PollSometimes poll_here;
    for (std::int64_t i = begin; i < end; ++i) {
      for (std::int64_t j = i + 1; j < count && entries[j].cell == entries[i].cell; ++j) {
        poll_here();
        const Side &s = sides[entries[i].side], &t = sides[entries[j].side];
        if (compared(charts, s, t)) own = std::min(own, distance(s, t));
      }
    }
  });
  return *std::min_element(least.begin(), least.end());
}

/// Whether some page has two charts to compare.
bool has_pairs(const PagedCharts& charts, const std::vector<Side>& sides) {
  std::vector<Index> first(charts.page_of_chart.size() + 1, kNone);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Index& known = first[std::min<Index>(sides[i].page, size_of(first) - 1)];
    if (known == kNone) known = static_cast<Index>(i);
    if (compared(charts, sides[known], sides[i])) return true;
  }
  return false;
}

}  // namespace

double least_margin(const PagedCharts& charts, const Work& work) {
  const std::vector<Side> sides = sides_of(charts, work);
  double margin = kInfinity;
  for (const Side& side : sides) {
    if (!charts.kept.empty() && charts.kept[side.chart]) continue;
    const double inside = std::min(side.a.minCoeff(), charts.resolution - side.a.maxCoeff());
    margin = std::min(margin, 2 * inside);
  }
  if (!has_pairs(charts, sides)) return margin;
  double between = kInfinity;
  for (double reach = kFirstReach;; reach *= 2) {
    between = least_within(charts, sides, reach, work);
    // What is further apart than so is neither the least nor on one page.
    if (between <= reach || reach >= margin || reach > 2.0 * charts.resolution) break;
  }
  return std::min(margin, between);
}

}  // namespace beltrami
