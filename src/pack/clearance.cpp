#include "pack/clearance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "pack/edge_grid.h"

namespace beltrami {
namespace {

double side_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Whether two segments cross at a point inside both; those that touch are at distance 0 anyway.
bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

double distance(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (cross(a, b, c, d)) return 0;
  const double squared =
      std::min({(nearest_on(a, b, c) - c).squaredNorm(), (nearest_on(a, b, d) - d).squaredNorm(),
                (nearest_on(c, d, a) - a).squaredNorm(), (nearest_on(c, d, b) - b).squaredNorm()});
  return std::sqrt(squared);
}

Eigen::AlignedBox2d box_of(const PlacedOutline& chart) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : chart.points) box.extend(p);
  return box;
}

/// The number of the chart's faces over a place that is not on its border.
int winding(const PlacedOutline& chart, const Vec2& place) {
  int winding = 0;
  for (const auto& [from, to] : chart.edges) {
    const Vec2 &p = chart.points[from], &q = chart.points[to];
    if ((p.y() <= place.y()) == (q.y() <= place.y())) continue;
    const bool up = p.y() <= place.y();
    if ((side_of(p, q, place) > 0) == up) winding += up ? 1 : -1;
  }
  return winding;
}

/// A point of each connected part of a border.
std::vector<Vec2> points_of_parts(const PlacedOutline& chart) {
  const Index count = size_of(chart.points);
  DisjointSets sets(count);
  for (Index p = 0; p < count; ++p) sets.make(p);
  for (const auto& [from, to] : chart.edges) sets.unite(from, to);
  std::vector<Vec2> points;
  for (Index p = 0; p < count; ++p) {
    if (sets.root(p) == p) points.push_back(chart.points[p]);
  }
  return points;
}

/// Whether a chart lies on another, no borders of which cross.
bool any_on_another(const std::vector<PlacedOutline>& charts) {
  std::vector<Index> order;  // by the left side of their boxes
  std::vector<Eigen::AlignedBox2d> boxes;
  for (Index c = 0; c < size_of(charts); ++c) {
    boxes.push_back(box_of(charts[c]));
    if (!boxes.back().isEmpty()) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return boxes[a].min().x() < boxes[b].min().x(); });
  std::vector<std::vector<Vec2>> parts(charts.size());
  for (const Index c : order) parts[c] = points_of_parts(charts[c]);
  PollSometimes poll;
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      poll();
      const Index a = order[i], b = order[j];
      if (boxes[b].min().x() > boxes[a].max().x()) break;
      if (charts[a].stays && charts[b].stays) continue;
      if (charts[a].page != charts[b].page || !boxes[a].intersects(boxes[b])) continue;
      const auto lies_on = [&](Index upper, Index lower) {
        return std::any_of(parts[upper].begin(), parts[upper].end(), [&](const Vec2& p) {
          poll_interrupt();  // a winding goes over all of a border
          return boxes[lower].contains(p) && winding(charts[lower], p) != 0;
        });
      };
      if (lies_on(a, b) || lies_on(b, a)) return true;
    }
  }
  return false;
}

}  // namespace

Clearance clearance(const std::vector<PlacedOutline>& charts, double side, double reach) {
  Clearance least{reach, reach};
  for (const PlacedOutline& chart : charts) {
    const Eigen::AlignedBox2d box = box_of(chart);
    if (box.isEmpty() || chart.stays) continue;
    least.page = std::min({least.page, box.min().minCoeff(), side - box.max().maxCoeff()});
  }
  // A walk along an edge passes within half a step of its point that is nearest to the other.
  constexpr double kStep = 2;
  const EdgeGrid grid(charts, reach + kStep / 2);
  PollSometimes poll;
  for (Index c = 0; c < size_of(charts); ++c) {
    for (const auto& [from, to] : charts[c].edges) {
      const Vec2 &p = charts[c].points[from], &q = charts[c].points[to];
      const int pieces = static_cast<int>((q - p).norm() / kStep) + 1;
      for (int k = 0; k <= pieces; ++k) {
        const Vec2 place = p + (q - p) * (static_cast<double>(k) / pieces);
        for (const ChartEdge& other : grid.near(charts[c].page, place)) {
          poll();
          if (other.chart <= c) continue;
          const PlacedOutline& chart = charts[other.chart];
          if (chart.stays && charts[c].stays) continue;
          const auto& [start, end] = chart.edges[other.edge];
          least.charts =
              std::min(least.charts, distance(p, q, chart.points[start], chart.points[end]));
        }
      }
    }
  }
  if (least.charts > 0 && any_on_another(charts)) least.charts = 0;
  return least;
}

}  // namespace beltrami
