// The half-edges of a triangle list, edge by edge: the one way to find opposite ones.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Half-edges 3 * face + corner of a triangle list by the smaller of their end vertices.
struct HalfedgeBuckets {
  std::vector<Index> start;     ///< per vertex, and one more
  std::vector<Index> halfedge;  ///< in increasing order in each bucket
};

/// A half-edge seen from its smaller end.
struct Spoke {
  Index far, halfedge;
  bool outwards;
};

/// The origin and the target of half-edge h.
inline std::array<Index, 2> ends_of(const std::vector<Triangle>& faces, Index h) {
  const Triangle& face = faces[h / 3];
  return {face[h % 3], face[next_corner(h % 3)]};
}

/// Precondition: indices in [0, vertex_count), no face names a vertex twice.
HalfedgeBuckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                               const Work& work);

/// Calls visit(std::span<const Spoke>) with the half-edges of each edge, once, in either direction:
/// no hash map, no sort over the whole. Several threads call it side by side.
template <class Visit>
void for_each_edge(const Work& work, const HalfedgeBuckets& buckets,
                   const std::vector<Triangle>& faces, const Visit& visit) {
  constexpr std::int64_t kGrain = 16384;
  const std::int64_t vertex_count = size_of(buckets.start) - 1;
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Spoke> spokes;
    for (std::int64_t v = begin; v < end; ++v) {
      spokes.clear();
      for (Index i = buckets.start[v]; i < buckets.start[v + 1]; ++i) {
        const Index h = buckets.halfedge[i];
        const auto [from, to] = ends_of(faces, h);
        spokes.push_back({std::max(from, to), h, from < to});
      }
      sort_interruptibly(spokes.begin(), spokes.end(),
                         [](const Spoke& a, const Spoke& b) { return a.far < b.far; });
      for (std::size_t first = 0, last = 0; first < spokes.size(); first = last) {
        while (last < spokes.size() && spokes[last].far == spokes[first].far) ++last;
        visit(std::span<const Spoke>(spokes).subspan(first, last - first));
      }
    }
  });
}

}  // namespace beltrami
