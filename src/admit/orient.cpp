#include "admit/orient.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/edges.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// Turns the faces [begin, end) of `order` over if that leaves more of them as they are.
void keep_majority(const std::vector<Index>& order, std::size_t begin,
                   std::vector<bool>& reversed) {
  std::size_t count = 0;
  for (std::size_t i = begin; i < order.size(); ++i) count += reversed[order[i]] ? 1 : 0;
  if (2 * count <= order.size() - begin) return;
  for (std::size_t i = begin; i < order.size(); ++i) reversed[order[i]] = !reversed[order[i]];
}

/// Half-edge h, where its face is turned over.
Index turned(Index h) {
  return h + 2 - 2 * (h % 3);
}

}  // namespace

Gluing glue(Index vertex_count, const std::vector<Triangle>& faces,
            const std::vector<Index>& layers, const Work& work) {
  Gluing gluing;
  parallel_assign(work, gluing.twin, 3 * faces.size(), kNone);
  const auto join = [&](Index one, Index other) {
    gluing.twin[one] = other;
    gluing.twin[other] = one;
  };
  std::atomic<Index> crowded{0};
  const HalfedgeBuckets buckets = sort_halfedges(vertex_count, faces, work);
  for_each_edge(work, buckets, faces, [&](std::span<const Spoke> edge) {
    if (edge.size() < 2) return;
    if (edge.size() == 2) {
      const Index one = edge[0].halfedge, other = edge[1].halfedge;
      if (layers[one / 3] == layers[other / 3]) join(one, other);
      return;
    }
    std::vector<std::array<Index, 2>> by_layer;
    for (const Spoke& spoke : edge) {
      by_layer.push_back({layers[spoke.halfedge / 3], spoke.halfedge});
    }
    sort_interruptibly(by_layer.begin(), by_layer.end(), std::less<>());
    for (std::size_t first = 0, last = 0; first < by_layer.size(); first = last) {
      while (last < by_layer.size() && by_layer[last][0] == by_layer[first][0]) ++last;
      if (last - first == 2) join(by_layer[first][1], by_layer[first + 1][1]);
      if (last - first > 2) ++crowded;
    }
  });
  gluing.crowded_edges = crowded;
  return gluing;
}

Orientation orient(std::vector<Triangle>& faces, std::vector<Index>& twin, const Work& work) {
  Orientation result;
  result.reversed.assign(faces.size(), false);
  std::vector<bool>& reversed = result.reversed;
  std::vector<bool> seen(faces.size(), false);
  std::vector<Index> order;
  order.reserve(faces.size());
  PollSometimes poll;
  for (Index seed = 0; seed < size_of(faces); ++seed) {
    if (seen[seed]) continue;
    const std::size_t begin = order.size();
    seen[seed] = true;
    order.push_back(seed);
    for (std::size_t i = begin; i < order.size(); ++i) {
      poll();
      for (int k = 0; k < 3; ++k) {
        const Index h = 3 * order[i] + k, other = twin[h];
        if (other == kNone) continue;
        const bool alike = ends_of(faces, h)[0] == ends_of(faces, other)[0];
        const bool wanted = reversed[order[i]] != alike;
        if (!seen[other / 3]) {
          seen[other / 3] = true;
          reversed[other / 3] = wanted;
          order.push_back(other / 3);
        } else if (reversed[other / 3] != wanted) {
          twin[h] = twin[other] = kNone;
          ++result.one_sided_edges;
        }
      }
    }
    keep_majority(order, begin, reversed);
  }

  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      if (reversed[f]) {
        std::swap(faces[f][1], faces[f][2]);
        std::swap(twin[3 * f], twin[3 * f + 2]);
      }
      for (int k = 0; k < 3; ++k) {
        Index& other = twin[3 * f + k];
        if (other != kNone && reversed[other / 3]) other = turned(other);
      }
    }
  });
  return result;
}

}  // namespace beltrami
