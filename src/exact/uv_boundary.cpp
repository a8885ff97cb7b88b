#include "exact/uv_boundary.h"

#include <algorithm>
#include <numeric>

#include "base/bucket_sort.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// An edge in the bucket of its lower vertex.
struct BucketEdge {
  Index higher, corner;
};

/// The edges of all triangles with a sign, by their lower vertex, then the higher one.
struct EdgeBuckets {
  std::vector<Index> start;
  std::vector<BucketEdge> edges;
};

EdgeBuckets bucket_edges(const SignedTriangles& triangles, const Work& work) {
  const auto ends = [&](std::int64_t f, int k) {
    const Triangle& face = triangles.faces[f];
    return std::minmax(face[k], face[(k + 1) % 3]);
  };
  EdgeBuckets buckets;
  BucketSort<Index> sort(work, size_of(triangles.faces), size_of(triangles.uvs), buckets.start,
                         [&](std::int64_t f, const auto& visit) {
                           if (triangles.signs[f] == 0) return;
                           for (int k = 0; k < 3; ++k) visit(ends(f, k).first);
                         });
  buckets.edges.resize(static_cast<std::size_t>(buckets.start.back()));
  sort.place([&](std::int64_t f, const auto& visit) {
    if (triangles.signs[f] == 0) return;
    for (int k = 0; k < 3; ++k) {
      const auto [lower, higher] = ends(f, k);
      buckets.edges[visit(lower)] = {higher, static_cast<Index>(3 * f + k)};
    }
  });
  parallel_for(work, size_of(triangles.uvs), kGrain, [&](std::int64_t from, std::int64_t until) {
    for (std::int64_t v = from; v < until; ++v) {
      sort_interruptibly(buckets.edges.begin() + buckets.start[v],
                         buckets.edges.begin() + buckets.start[v + 1],
                         [](const BucketEdge& a, const BucketEdge& b) {
                           return a.higher != b.higher ? a.higher < b.higher : a.corner < b.corner;
                         });
    }
  });
  return buckets;
}

/// Calls visit(lower vertex, first, last) for each set of edges between the same vertices, the
/// lower of which is in [from, until).
template <class Visit>
void for_each_edge(const EdgeBuckets& buckets, std::int64_t from, std::int64_t until,
                   const Visit& visit) {
  for (std::int64_t v = from; v < until; ++v) {
    const BucketEdge* first = buckets.edges.data() + buckets.start[v];
    const BucketEdge* const end = buckets.edges.data() + buckets.start[v + 1];
    for (const BucketEdge* last = first; first != end; first = last) {
      while (last != end && last->higher == first->higher) ++last;
      visit(static_cast<Index>(v), first, last);
    }
  }
}

UvEdge directed(const SignedTriangles& triangles, Index corner) {
  const Index f = corner / 3, k = corner % 3;
  const Index a = triangles.faces[f][k], b = triangles.faces[f][(k + 1) % 3];
  return triangles.signs[f] > 0 ? UvEdge{a, b, corner} : UvEdge{b, a, corner};
}

}  // namespace

UvBoundary uv_boundary(const SignedTriangles& triangles, const Work& work) {
  const EdgeBuckets buckets = bucket_edges(triangles, work);
  const std::int64_t count = size_of(triangles.uvs);
  std::vector<UvBoundary> parts(static_cast<std::size_t>((count + kGrain - 1) / kGrain));
  const auto collect = [&](UvBoundary& part, Index lower, const BucketEdge* first,
                           const BucketEdge* last) {
    std::int64_t up = 0;
    for (const BucketEdge* e = first; e != last; ++e) {
      up += directed(triangles, e->corner).from == lower;
    }
    const std::int64_t down = last - first - up;
    if (up == 1 && down == 1) return;
    for (const BucketEdge* e = first; e != last; ++e) {
      const UvEdge edge = directed(triangles, e->corner);
      const bool doubled = (edge.from == lower ? up : down) > 1;
      if (doubled && part.first_doubled == kNone) part.first_doubled = size_of(part.edges);
      part.edges.push_back(edge);
    }
  };
  parallel_for(work, count, kGrain, [&](std::int64_t from, std::int64_t until) {
    UvBoundary& part = parts[static_cast<std::size_t>(from / kGrain)];
    for_each_edge(buckets, from, until, [&](Index lower, const auto* first, const auto* last) {
      collect(part, lower, first, last);
    });
  });
  UvBoundary boundary;
  for (const UvBoundary& part : parts) {
    if (boundary.first_doubled == kNone && part.first_doubled != kNone) {
      boundary.first_doubled = size_of(boundary.edges) + part.first_doubled;
    }
    boundary.edges.insert(boundary.edges.end(), part.edges.begin(), part.edges.end());
  }
  return boundary;
}

std::vector<Index> uv_charts(const SignedTriangles& triangles, const Work& work) {
  const EdgeBuckets buckets = bucket_edges(triangles, work);
  std::vector<Index> parent(triangles.faces.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  PollSometimes poll;
  for_each_edge(buckets, 0, size_of(triangles.uvs),
                [&](Index, const BucketEdge* first, const BucketEdge* last) {
                  poll();
                  for (const BucketEdge* e = first + 1; e < last; ++e) {
                    const Index a = root(first->corner / 3), b = root(e->corner / 3);
                    parent[std::max(a, b)] = std::min(a, b);
                  }
                });
  std::vector<Index> chart(parent.size(), kNone);
  Index charts = 0;
  for (Index f = 0; f < size_of(parent); ++f) {
    poll();
    if (triangles.signs[f] == 0) continue;
    const Index first = root(f);
    chart[f] = first == f ? charts++ : chart[first];
  }
  return chart;
}

}  // namespace beltrami
