#include "mesh/split_fans.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/bucket_sort.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

struct Fans {
  std::vector<Index> of_corner;
  std::vector<Index> vertex;  ///< per fan
};

/// Fans in the order of their least corners.
Fans walk_fans(const std::vector<Triangle>& faces, const std::vector<Index>& twin) {
  Fans fans;
  fans.of_corner.assign(twin.size(), kNone);
  PollSometimes poll;
  for (Index corner = 0; corner < size_of(twin); ++corner) {
    if (fans.of_corner[corner] != kNone) continue;
    const Index fan = size_of(fans.vertex);
    fans.vertex.push_back(faces[corner / 3][corner % 3]);
    const auto take = [&](Index h) {
      poll();
      fans.of_corner[h] = fan;
    };
    Index h = corner;
    do {
      take(h);
      h = twin[Surface::previous(h)];
    } while (h != kNone && h != corner);
    if (h == corner) continue;
    for (h = twin[corner]; h != kNone; h = twin[h]) {
      h = Surface::next(h);
      take(h);
    }
  }
  return fans;
}

/// Per fan its number in the order of the vertices.
std::vector<Index> by_vertex(const Fans& fans, Index vertex_count, const Work& work) {
  std::vector<Index> start, number(fans.vertex.size());
  BucketSort<Index> sort(work, size_of(fans.vertex), vertex_count, start,
                         [&](std::int64_t fan, const auto& count) { count(fans.vertex[fan]); });
  sort.place([&](std::int64_t fan, const auto& place) { number[fan] = place(fans.vertex[fan]); });
  return number;
}

/// Fills `outgoing` and `on_boundary` of a surface whose twins are known.
void link_vertices(Surface& surface) {
  surface.outgoing.assign(surface.positions.size(), kNone);
  surface.on_boundary.assign(surface.positions.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    const Index v = surface.origin(h);
    // On the boundary the one whose own edge lies there, else the least.
    if (surface.twin[h] == kNone) {
      surface.outgoing[v] = h;
      surface.on_boundary[v] = true;
    } else if (surface.outgoing[v] == kNone) {
      surface.outgoing[v] = h;
    }
  }
}

/// Positions and faces alone.
SplitSurface numbered_by_fan(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                             const std::vector<Index>& twin, const Work& work) {
  const Fans fans = walk_fans(faces, twin);
  const std::vector<Index> number = by_vertex(fans, size_of(positions), work);
  SplitSurface split;
  split.vertex.resize(number.size());
  std::vector<Vec3>& places = split.surface.positions;
  places.resize(number.size());
  parallel_for(work, size_of(number), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t fan = begin; fan < end; ++fan) {
      split.vertex[number[fan]] = fans.vertex[fan];
      places[number[fan]] = positions[fans.vertex[fan]];
    }
  });
  std::vector<Triangle>& renumbered = split.surface.faces;
  renumbered.resize(faces.size());
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (int k = 0; k < 3; ++k) renumbered[f][k] = number[fans.of_corner[3 * f + k]];
    }
  });
  return split;
}

}  // namespace

void part_double_edges(const std::vector<Triangle>& faces, std::vector<Index>& twin) {
  const Fans fans = walk_fans(faces, twin);
  struct Side {
    Index least, greatest;  // fans
    Index halfedge;
    auto ends() const { return std::pair(least, greatest); }
  };
  std::vector<Side> sides;
  sides.reserve(twin.size());
  for (Index h = 0; h < size_of(twin); ++h) {
    const auto [least, greatest] = std::minmax(fans.of_corner[h], fans.of_corner[Surface::next(h)]);
    sides.push_back({least, greatest, h});
  }
  sort_interruptibly(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.ends() != b.ends() ? a.ends() < b.ends() : a.halfedge < b.halfedge;
  });
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].ends() == sides[first].ends()) ++last;
    for (std::size_t i = first; last - first > 2 && i < last; ++i) {
      const Index other = std::exchange(twin[sides[i].halfedge], kNone);
      if (other != kNone) twin[other] = kNone;
    }
  }
}

SplitSurface split_fans(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        const std::vector<Index>& twin, const Work& work) {
  SplitSurface split = numbered_by_fan(positions, faces, twin, work);
  Surface& own = split.surface;
  own = build_surface(std::move(own.positions), std::move(own.faces), work);
  return split;
}

SplitSurface split_along(const Surface& surface, const std::vector<bool>& apart, const Work& work) {
  std::vector<Index> twin = surface.twin;
  parallel_for(work, size_of(twin), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t h = begin; h < end; ++h) {
      if (apart[h]) twin[h] = kNone;
    }
  });
  SplitSurface split = numbered_by_fan(surface.positions, surface.faces, twin, work);
  Surface& own = split.surface;
  // An edge whose sides have the same ends still is no opening.
  for (Index h = 0; h < size_of(twin); ++h) {
    const Index other = surface.twin[h];
    if (!apart[h] || other == kNone) continue;
    if (own.origin(h) == own.target(other) && own.target(h) == own.origin(other)) twin[h] = other;
  }
  own.twin = std::move(twin);
  link_vertices(own);
  return split;
}

}  // namespace beltrami
