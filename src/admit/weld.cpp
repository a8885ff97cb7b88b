#include "admit/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/bucket_sort.h"
#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
/// Cells whose neighbours are sought before any of them is united: bounds what is noted.
constexpr std::int64_t kBlock = 1 << 16;
/// In units of cells: two points of one cell are no further apart than its diagonal, sqrt(3), and
/// points no further apart than two sides are at most two cells apart in each direction.
constexpr int kReach = 2;

/// Points by a hash of their coordinates.
class PointTable {
 public:
  PointTable(const std::vector<Vec3>& points, const Work& work)
      : points_(points), mask_(std::bit_ceil(points.size()) - 1), found_(points.size()) {
    BucketSort<Index> sort(work, size_of(points), static_cast<std::int64_t>(mask_) + 1, start_,
                           [&](std::int64_t i, const auto& count) { count(bucket(points[i])); });
    sort.place([&](std::int64_t i, const auto& place) {
      found_[place(bucket(points[i]))] = static_cast<Index>(i);
    });
  }

  /// The least index of a point that equals `point`, or kNone.
  Index find(const Vec3& point) const {
    const std::size_t b = bucket(point);
    for (Index i = start_[b]; i < start_[b + 1]; ++i) {
      if (points_[found_[i]] == point) return found_[i];
    }
    return kNone;
  }

 private:
  std::size_t bucket(const Vec3& point) const {
    std::uint64_t hash = 0;
    for (const double x : point) {
      hash ^= std::bit_cast<std::uint64_t>(x + 0.0);  // -0 becomes 0
      hash *= 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    hash *= 0xBF58476D1CE4E5B9u;
    return (hash ^ (hash >> 32)) & mask_;
  }

  const std::vector<Vec3>& points_;
  std::size_t mask_;
  std::vector<Index> start_, found_;
};

std::vector<Index> weld_equal(const std::vector<Vec3>& positions, const PointTable& table,
                              const Work& work) {
  std::vector<Index> first(positions.size());
  parallel_for(work, size_of(positions), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) first[i] = table.find(positions[i]);
  });
  return first;
}

/// Points by the first point in their cell.
struct Cells {
  std::vector<Index> start, point;
};

/// Whether a point of one cell is within the distance of a point of the other.
bool are_near(const std::vector<Vec3>& positions, const Cells& cells, Index one, Index other,
              double distance) {
  PollSometimes poll;
  for (Index i = cells.start[one]; i < cells.start[one + 1]; ++i) {
    for (Index j = cells.start[other]; j < cells.start[other + 1]; ++j) {
      poll();
      if ((positions[cells.point[i]] - positions[cells.point[j]]).norm() <= distance) return true;
    }
  }
  return false;
}

/// The half of the neighbours of a cell that come after it.
std::vector<Vec3> later_neighbours() {
  std::vector<Vec3> offsets;
  for (int x = -kReach; x <= kReach; ++x) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int z = -kReach; z <= kReach; ++z) {
        if (std::array{x, y, z} > std::array{0, 0, 0}) offsets.emplace_back(x, y, z);
      }
    }
  }
  return offsets;
}

std::vector<Index> weld_near(const std::vector<Vec3>& positions, double distance,
                             const Work& work) {
  const Index count = size_of(positions);
  const double side = distance / kReach;
  std::vector<Vec3> corner(positions.size());
  parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) corner[i][k] = std::floor(positions[i][k] / side);
    }
  });
  const PointTable table(corner, work);
  const std::vector<Index> cell = weld_equal(corner, table, work);
  Cells cells;
  cells.point.resize(positions.size());
  BucketSort<Index> sort(work, count, count, cells.start,
                         [&](std::int64_t i, const auto& visit) { visit(cell[i]); });
  sort.place([&](std::int64_t i, const auto& place) {
    cells.point[place(cell[i])] = static_cast<Index>(i);
  });

  const std::vector<Vec3> offsets = later_neighbours();
  DisjointSets sets(count);
  PollSometimes poll;
  for (Index i = 0; i < count; ++i) {
    poll();
    sets.make(i);
    sets.unite(cell[i], i);  // the first of its cell, made before
  }
  std::vector<std::vector<std::array<Index, 2>>> near(kBlock / kGrain);
  for (std::int64_t first = 0; first < count; first += kBlock) {
    parallel_for(work, std::min(kBlock, count - first), kGrain,
                 [&](std::int64_t begin, std::int64_t end) {
                   auto& found = near[begin / kGrain];
                   found.clear();
                   for (auto i = static_cast<Index>(first + begin); i < first + end; ++i) {
                     if (cell[i] != i) continue;
                     for (const Vec3& offset : offsets) {
                       const Index other = table.find(corner[i] + offset);
                       if (other == kNone || other == i) continue;
                       if (are_near(positions, cells, i, other, distance)) {
                         found.push_back({i, other});
                       }
                     }
                   }
                 });
    for (auto& found : near) {
      for (const auto& [one, other] : found) sets.unite(one, other);
      found.clear();
    }
  }
  return std::move(sets).roots();
}

}  // namespace

std::vector<Index> weld(const std::vector<Vec3>& positions, double distance, const Work& work) {
  double greatest = 0;
  PollSometimes poll;
  for (const Vec3& p : positions) {
    poll();
    greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  }
  // A part of the least number rounds to 0, and cells would have no size.
  const bool has_cells = distance > std::ldexp(greatest, -50) && distance / kReach > 0;
  if (has_cells) return weld_near(positions, distance, work);
  return weld_equal(positions, PointTable(positions, work), work);
}

std::vector<Index> each_its_own(Index count) {
  std::vector<Index> first(count);
  std::iota(first.begin(), first.end(), 0);
  return first;
}

}  // namespace beltrami
