// Values at the vertices of a coarse disk, carried to a finer one and back.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Where a fine vertex lies on the coarse disk. The share of the first corner is what the two
/// others leave of 1.
struct Footpoint {
  Index halfedge;               ///< of the coarse mesh: its face, from its origin on
  std::array<float, 2> shares;  ///< of its target and of the third corner, >= 0

  Footpoint() {}  // leaves a large array as it is: no thread fills it before it is written
  Footpoint(Index on, const std::array<float, 2>& at) : halfedge(on), shares(at) {}

  float first_share() const { return 1 - shares[0] - shares[1]; }
  /// The coarse vertices.
  Triangle corners(const std::vector<Triangle>& faces) const {
    const Triangle& face = faces[halfedge / 3];
    const Index k = halfedge % 3;
    return {face[k], face[next_corner(k)], face[previous_corner(k)]};
  }
};

/// Per vertex of `fine` its point of `coarse`: the closest one near the coarse vertex that it was
/// collapsed into, so that none is sought across a seam; on the boundary by arc length along the
/// coarse edge that replaced its part of the loop; of what is a coarse vertex itself that vertex.
/// `fine_vertex`: per coarse vertex the fine one that it is; `nearby`: per fine vertex the coarse
/// one that it was collapsed into.
std::vector<Footpoint> footpoints(const DiskMesh& coarse, const std::vector<Index>& fine_vertex,
                                  const std::vector<Index>& nearby, const DiskMesh& fine,
                                  const Work& work);

/// What `values` at the vertices of the coarse faces are at a footpoint.
template <class Value>
Value interpolated(const Footpoint& at, const std::vector<Triangle>& faces,
                   const std::vector<Value>& values) {
  const Triangle corners = at.corners(faces);
  const Value& first = values[corners[0]];
  return first + at.shares[0] * (values[corners[1]] - first) +
         at.shares[1] * (values[corners[2]] - first);
}

/// The same at all of them.
template <class Value>
std::vector<Value> carried(const std::vector<Value>& values, const std::vector<Triangle>& faces,
                           const std::vector<Footpoint>& points, const Work& work) {
  constexpr std::int64_t kGrain = 1024;
  std::vector<Value> fine(points.size());
  parallel_for(work, size_of(points), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) fine[v] = interpolated(points[v], faces, values);
  });
  return fine;
}

}  // namespace beltrami
