#include "mesh/locality.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "base/bucket_sort.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr int kBits = 11;  // per axis: vertices that share a cell stay in the order of the input
constexpr int kDigit = 11;
constexpr std::int64_t kGrain = 16384;

using Cell = std::array<std::uint32_t, 3>;

/// Where a cell comes on the Hilbert curve (Skilling 2004, "Programming the Hilbert curve").
std::uint64_t hilbert_key(Cell x) {
  for (std::uint32_t q = 1u << (kBits - 1); q > 1; q >>= 1) {
    const std::uint32_t below = q - 1;
    for (int i = 0; i < 3; ++i) {
      if (x[i] & q) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ x[i]) & below;
        x[0] ^= swapped;
        x[i] ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t parity = 0;
  for (std::uint32_t q = 1u << (kBits - 1); q > 1; q >>= 1) {
    if (x[2] & q) parity ^= q - 1;
  }
  std::uint64_t key = 0;
  for (int bit = kBits; bit-- > 0;) {
    for (int i = 0; i < 3; ++i) key = key << 1 | ((x[i] ^ parity) >> bit & 1);
  }
  return key;
}

}  // namespace

std::vector<Index> along_hilbert_curve(const std::vector<Vec3>& points, const Work& work) {
  if (points.empty()) return {};
  Vec3 low = points.front(), high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // Halves, since the sides of a box of the largest numbers overflow.
  const double side = (0.5 * high - 0.5 * low).maxCoeff();
  constexpr double kCells = (1 << kBits) - 1;
  using Keyed = std::pair<std::uint64_t, Index>;
  std::vector<Keyed> keyed, sorted;
  parallel_assign(work, keyed, points.size());
  parallel_assign(work, sorted, points.size());
  parallel_for(work, size_of(points), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      Cell cell{};
      for (int i = 0; i < 3 && side > 0; ++i) {
        cell[i] = static_cast<std::uint32_t>(
            std::clamp((0.5 * points[v][i] - 0.5 * low[i]) / side, 0.0, 1.0) * kCells);
      }
      keyed[v] = {hilbert_key(cell), v};
    }
  });
  std::vector<Index> start;
  for (int shift = 0; shift < 3 * kBits; shift += kDigit) {
    const auto digit = [&](std::int64_t i) {
      return keyed[i].first >> shift & ((1u << kDigit) - 1);
    };
    BucketSort<Index> sort(work, size_of(keyed), 1 << kDigit, start,
                           [&](std::int64_t i, const auto& count) { count(digit(i)); });
    sort.place([&](std::int64_t i, const auto& place) { sorted[place(digit(i))] = keyed[i]; });
    keyed.swap(sorted);
  }
  std::vector<Index> order;
  parallel_assign(work, order, points.size());
  std::transform(keyed.begin(), keyed.end(), order.begin(),
                 [](const Keyed& k) { return k.second; });
  return order;
}

std::vector<Index> by_least_vertex(Index vertex_count, const std::vector<Triangle>& faces,
                                   const Work& work) {
  const auto least = [&](std::int64_t f) {
    return std::min({faces[f][0], faces[f][1], faces[f][2]});
  };
  std::vector<Index> start, sorted;
  parallel_assign(work, sorted, faces.size());
  BucketSort<Index> sort(work, size_of(faces), vertex_count, start,
                         [&](std::int64_t f, const auto& count) { count(least(f)); });
  sort.place(
      [&](std::int64_t f, const auto& place) { sorted[place(least(f))] = static_cast<Index>(f); });
  return sorted;
}

Arrangement arrange(const std::vector<Vec3>& positions, std::vector<Triangle>& faces,
                    const Work& work) {
  Arrangement arranged{along_hilbert_curve(positions, work), {}};
  std::vector<Index> place;
  parallel_assign(work, place, positions.size());
  parallel_for(work, size_of(place), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) place[arranged.vertices[i]] = i;
  });
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (Index& v : faces[f]) v = place[v];
    }
  });
  arranged.faces = by_least_vertex(size_of(positions), faces, work);
  faces = in_order(faces, arranged.faces, work);
  return arranged;
}

}  // namespace beltrami
