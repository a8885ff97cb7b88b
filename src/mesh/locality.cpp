#include "mesh/locality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>

#include "base/bucket_sort.h"
#include "base/parallel.h"
#include "base/scratch.h"

namespace beltrami {
namespace {

constexpr int kBits = 11;  // per axis: vertices that share a cell stay in the order of the input
constexpr int kDigit = 11;
constexpr int kIndexBits = 31;  // with a key, those of a word
constexpr std::int64_t kGrain = 16384;
constexpr int kLanes = 8;

using Lanes = std::array<std::uint32_t, kLanes>;

template <class Body>
void for_each_lane(const Body& body) {
  for (int lane = 0; lane < kLanes; ++lane) body(lane);
}

/// The bits of numbers of kBits, two empty ones after each.
Lanes spread(Lanes x) {
  for_each_lane([&](int l) {
    x[l] = (x[l] | x[l] << 16) & 0x070000FF;
    x[l] = (x[l] | x[l] << 8) & 0x0700F00F;
    x[l] = (x[l] | x[l] << 4) & 0x430C30C3;
    x[l] = (x[l] | x[l] << 2) & 0x49249249;
  });
  return x;
}

/// Where cells come on the Hilbert curve (Skilling 2004, "Programming the Hilbert curve"), without
/// branches that half of the cells take.
std::array<std::uint64_t, kLanes> hilbert_keys(std::array<Lanes, 3>& x) {
  for (int bit = kBits; --bit > 0;) {
    const std::uint32_t below = (1U << bit) - 1;
    const auto all_of_bit = [bit](std::uint32_t word) { return 0U - (word >> bit & 1); };
    for_each_lane([&](int l) { x[0][l] ^= below & all_of_bit(x[0][l]); });
    for (int i = 1; i < 3; ++i) {
      for_each_lane([&](int l) {
        const std::uint32_t set = all_of_bit(x[i][l]);
        const std::uint32_t swapped = (x[0][l] ^ x[i][l]) & below & ~set;
        x[0][l] ^= (below & set) | swapped;
        x[i][l] ^= swapped;
      });
    }
  }
  for_each_lane([&](int l) {
    x[1][l] ^= x[0][l];
    x[2][l] ^= x[1][l];
    std::uint32_t parity = x[2][l] >> 1;
    for (int shift = 1; shift < kBits; shift *= 2) parity ^= parity >> shift;
    for (Lanes& xi : x) xi[l] ^= parity;
  });
  for (Lanes& xi : x) xi = spread(xi);
  std::array<std::uint64_t, kLanes> keys;
  for_each_lane([&](int l) { keys[l] = std::uint64_t{x[0][l]} << 2 | x[1][l] << 1 | x[2][l]; });
  return keys;
}

/// Where the points come on the curve, with their numbers in the low bits.
void number_cells(const std::vector<Vec3>& points, const Work& work, Scratch<std::uint64_t>& keys) {
  const Eigen::AlignedBox3d box = bounding_box(points, work);
  // Halves, since the sides of a box of the largest numbers overflow.
  const Vec3 low = 0.5 * box.min();
  const double side = (0.5 * box.max() - low).maxCoeff();
  constexpr double kCells = (1 << kBits) - 1;
  parallel_for(work, size_of(points), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t first = begin; first < end; first += kLanes) {
      const auto lanes = static_cast<int>(std::min<std::int64_t>(kLanes, end - first));
      std::array<Lanes, 3> cells{};
      for (int l = 0; l < lanes && side > 0; ++l) {
        for (int i = 0; i < 3; ++i) {
          const double place = std::clamp((0.5 * points[first + l][i] - low[i]) / side, 0.0, 1.0);
          cells[i][l] = static_cast<std::uint32_t>(place * kCells);
        }
      }
      const auto own = hilbert_keys(cells);
      for (int l = 0; l < lanes; ++l) {
        keys[first + l] = own[l] << kIndexBits | static_cast<std::uint64_t>(first + l);
      }
    }
  });
}

}  // namespace

Eigen::AlignedBox3d bounding_box(const std::vector<Vec3>& points, const Work& work) {
  std::vector<Eigen::AlignedBox3d> of_chunk((points.size() + kGrain - 1) / kGrain);
  parallel_for(work, size_of(points), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Eigen::AlignedBox3d own;
    for (std::int64_t v = begin; v < end; ++v) own.extend(points[v]);
    of_chunk[begin / kGrain] = own;
  });
  Eigen::AlignedBox3d box;
  for (const Eigen::AlignedBox3d& own : of_chunk) box.extend(own);
  return box;
}

std::vector<Index> along_hilbert_curve(const std::vector<Vec3>& points, const Work& work) {
  if (points.empty()) return {};
  Scratch<std::uint64_t> keys(work, points.size()), sorted(work, points.size());
  number_cells(points, work, keys);
  std::vector<Index> start, order;
  parallel_assign(work, order, points.size());
  constexpr int kEnd = kIndexBits + 3 * kBits;
  for (int shift = kIndexBits; shift < kEnd; shift += kDigit) {
    const auto digit = [&](std::int64_t i) { return keys[i] >> shift & ((1U << kDigit) - 1); };
    BucketSort<Index> sort(work, size_of(points), 1 << kDigit, start,
                           [&](std::int64_t i, const auto& count) { count(digit(i)); });
    if (shift + kDigit < kEnd) {
      sort.place([&](std::int64_t i, const auto& place) { sorted[place(digit(i))] = keys[i]; });
      keys.swap(sorted);
    } else {
      constexpr std::uint64_t kIndex = (std::uint64_t{1} << kIndexBits) - 1;
      sort.place([&](std::int64_t i, const auto& place) {
        order[place(digit(i))] = static_cast<Index>(keys[i] & kIndex);
      });
    }
  }
  return order;
}

namespace {

Index least_vertex(const Triangle& face) {
  return std::min({face[0], face[1], face[2]});
}

}  // namespace

std::vector<Index> by_least_vertex(Index vertex_count, const std::vector<Triangle>& faces,
                                   const Work& work) {
  std::vector<Index> start, sorted;
  parallel_assign(work, sorted, faces.size());
  BucketSort<Index> sort(work, size_of(faces), vertex_count, start,
                         [&](std::int64_t f, const auto& count) { count(least_vertex(faces[f])); });
  sort.place([&](std::int64_t f, const auto& place) {
    sorted[place(least_vertex(faces[f]))] = static_cast<Index>(f);
  });
  return sorted;
}

Arrangement arrange(const std::vector<Vec3>& positions, std::vector<Triangle>& faces,
                    const Work& work) {
  Arrangement arranged{along_hilbert_curve(positions, work), {}};
  Scratch<Index> number(work, positions.size());
  parallel_for(work, size_of(positions), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) number[arranged.vertices[i]] = i;
  });
  std::vector<Index> start;
  parallel_assign(work, arranged.faces, faces.size());
  BucketSort<Index> sort(work, size_of(faces), size_of(positions), start,
                         [&](std::int64_t f, const auto& count) {
                           for (Index& v : faces[f]) v = number[v];
                           count(least_vertex(faces[f]));
                         });
  sort.place([&](std::int64_t f, const auto& place) {
    arranged.faces[place(least_vertex(faces[f]))] = static_cast<Index>(f);
  });
  faces = in_order(faces, arranged.faces, work);
  return arranged;
}

}  // namespace beltrami
