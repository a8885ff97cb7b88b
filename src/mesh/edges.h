// The half-edges of a triangle list, edge by edge.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// A half-edge 3 * face + corner seen from its smaller end.
class Spoke {
 public:
  Spoke() = default;
  Spoke(Index halfedge, Index from, Index to)
      : far_(from < to ? to : from), code_(from < to ? halfedge : ~halfedge) {}
  Index far() const { return far_; }
  Index halfedge() const { return outwards() ? code_ : ~code_; }
  bool outwards() const { return code_ >= 0; }

 private:
  Index far_, code_;
};

/// The half-edges of a triangle list by the smaller of their end vertices.
struct HalfedgeBuckets {
  std::vector<Index> start;   ///< per vertex, and one more
  std::vector<Spoke> spokes;  ///< their half-edges in increasing order in each bucket
};

/// The origin and the target of half-edge h.
inline std::array<Index, 2> ends_of(const std::vector<Triangle>& faces, Index h) {
  const Triangle& face = faces[h / 3];
  return {face[h % 3], face[next_corner(h % 3)]};
}

/// Precondition: indices in [0, vertex_count), no face names a vertex twice.
HalfedgeBuckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                               const Work& work);

/// Sorts half-edges of one smaller end by the other one, and calls visit(std::span<const Spoke>)
/// with those of each edge, in increasing order if they were.
template <class Visit>
void for_each_edge(std::span<Spoke> spokes, const Visit& visit) {
  constexpr std::size_t kFew = 32;  // that are sorted as they come
  Spoke* const first = spokes.data();
  Spoke* const last = first + spokes.size();
  if (spokes.size() > kFew) {
    sort_interruptibly(first, last, [](const Spoke& a, const Spoke& b) {
      return a.far() != b.far() ? a.far() < b.far() : a.halfedge() < b.halfedge();
    });
  } else {
    for (Spoke* next = first; next != last; ++next) {
      const Spoke spoke = *next;
      Spoke* place = next;
      for (; place != first && place[-1].far() > spoke.far(); --place) *place = place[-1];
      *place = spoke;
    }
  }
  for (const Spoke *at = first, *until = first; at != last; at = until) {
    while (until != last && until->far() == at->far()) ++until;
    visit(std::span<const Spoke>(at, until));
  }
}

/// Calls visit(std::span<const Spoke>) with the half-edges of each edge, once, in increasing order:
/// no hash map, no sort over the whole. Several threads call it side by side. Sorts the buckets on
/// the way.
template <class Visit>
void for_each_edge(const Work& work, HalfedgeBuckets& buckets, const Visit& visit) {
  constexpr std::int64_t kGrain = 16384;
  const std::int64_t vertex_count = size_of(buckets.start) - 1;
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Index from = buckets.start[v], to = buckets.start[v + 1];
      for_each_edge(std::span(buckets.spokes.data() + from, buckets.spokes.data() + to), visit);
    }
  });
}

}  // namespace beltrami
