#include "pack/edge_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/interrupt.h"

namespace beltrami {
namespace {

constexpr double kLeastCell = 4;  // texels
/// Cells along an edge of the mean length, at most: few long edges need no fine grid.
constexpr double kMostPerEdge = 4;
constexpr std::int64_t kMostPerSide = 4096;  // cells
/// Cells of all pages up to which each has its list, those without an edge included.
constexpr std::int64_t kMostInARow = 1 << 20;

}  // namespace

EdgeGrid::EdgeGrid(const std::vector<PlacedOutline>& charts, double reach) {
  Eigen::AlignedBox2d box;
  double length = 0;
  std::int64_t edges = 0;
  for (const PlacedOutline& chart : charts) {
    for (const Vec2& p : chart.points) box.extend(p);
    for (const auto& [from, to] : chart.edges) {
      length += (chart.points[to] - chart.points[from]).norm();
    }
    edges += size_of(chart.edges);
  }
  if (box.isEmpty()) return;
  low_ = box.min() - Vec2::Constant(reach);
  const Vec2 size = box.sizes() + Vec2::Constant(2 * reach);
  cell_ = std::max({kLeastCell, 2 * reach, size.maxCoeff() / kMostPerSide});
  if (edges > 0) cell_ = std::max(cell_, length / (kMostPerEdge * static_cast<double>(edges)));
  columns_ = static_cast<std::int64_t>(size.x() / cell_) + 1;
  rows_ = static_cast<std::int64_t>(size.y() / cell_) + 1;

  struct Entry {
    std::int64_t cell;
    ChartEdge edge;
  };
  std::vector<Entry> entries;
  std::int64_t pages = 0;
  for (Index c = 0; c < size_of(charts); ++c) {
    poll_interrupt();
    const PlacedOutline& chart = charts[c];
    pages = std::max<std::int64_t>(pages, chart.page + 1);
    for (Index e = 0; e < size_of(chart.edges); ++e) {
      const Vec2 &p = chart.points[chart.edges[e][0]], &q = chart.points[chart.edges[e][1]];
      const int pieces = static_cast<int>((q - p).norm() / cell_) + 1;
      for (int k = 0; k < pieces; ++k) {
        Eigen::AlignedBox2d piece(Vec2(p + (q - p) * (static_cast<double>(k) / pieces)));
        piece.extend(Vec2(p + (q - p) * (static_cast<double>(k + 1) / pieces)));
        const Vec2 first = (piece.min() - Vec2::Constant(reach) - low_) / cell_;
        const Vec2 last = (piece.max() + Vec2::Constant(reach) - low_) / cell_;
        const auto x0 = static_cast<std::int64_t>(std::max(first.x(), 0.0));
        const auto y0 = static_cast<std::int64_t>(std::max(first.y(), 0.0));
        for (auto y = y0; y <= static_cast<std::int64_t>(last.y()) && y < rows_; ++y) {
          for (auto x = x0; x <= static_cast<std::int64_t>(last.x()) && x < columns_; ++x) {
            entries.push_back({(chart.page * rows_ + y) * columns_ + x, {c, e}});
          }
        }
      }
    }
  }
  const std::int64_t cells = pages * rows_ * columns_;
  if (cells <= kMostInARow) {
    // By chart and edge in each cell, as they have come.
    start_.assign(static_cast<std::size_t>(cells) + 1, 0);
    for (const Entry& entry : entries) ++start_[entry.cell + 1];
    for (std::int64_t k = 0; k < cells; ++k) start_[k + 1] += start_[k];
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    edges_.resize(entries.size());
    for (const Entry& entry : entries) edges_[next[entry.cell]++] = entry.edge;
    return;
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
  edges_.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (cells_.empty() || cells_.back() != entry.cell) {
      cells_.push_back(entry.cell);
      start_.push_back(size_of(edges_));
    }
    edges_.push_back(entry.edge);
  }
  start_.push_back(size_of(edges_));
}

std::int64_t EdgeGrid::cell_of(Index page, const Vec2& place) const {
  const Vec2 at = (place - low_) / cell_;
  const auto x = std::clamp<std::int64_t>(static_cast<std::int64_t>(at.x()), 0, columns_ - 1);
  const auto y = std::clamp<std::int64_t>(static_cast<std::int64_t>(at.y()), 0, rows_ - 1);
  return (page * rows_ + y) * columns_ + x;
}

std::span<const ChartEdge> EdgeGrid::near(Index page, const Vec2& place) const {
  const std::int64_t cell = cell_of(page, place);
  if (cells_.empty()) {
    if (page < 0 || cell + 1 >= size_of(start_)) return {};
    return std::span(edges_).subspan(start_[cell], start_[cell + 1] - start_[cell]);
  }
  const auto found = std::lower_bound(cells_.begin(), cells_.end(), cell);
  if (found == cells_.end() || *found != cell) return {};
  const auto k = static_cast<std::size_t>(found - cells_.begin());
  return std::span(edges_).subspan(start_[k], start_[k + 1] - start_[k]);
}

}  // namespace beltrami
