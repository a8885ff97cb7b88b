#include "prolong/interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "base/vectors.h"
#include "mesh/boundary.h"
#include "mesh/closest_point.h"
#include "prolong/surface_walk.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 1024;
/// Coarse faces around a vertex that are looked at for the closest point, and through which a walk
/// is begun: at a hub the vertex itself is near enough.
constexpr int kMostFaces = 40;

/// A coarse vertex itself.
Footpoint at_vertex(const DiskMesh& coarse, Index v) {
  return {coarse.outgoing[v], {0, 0}};
}

/// The half-edge of the boundary that begins at a vertex.
Index boundary_halfedge(const DiskMesh& mesh, Index from) {
  Index found = kNone;
  mesh.for_each_outgoing(from, [&](Index h) {
    if (mesh.twin[h] == kNone) found = h;
  });
  return found;
}

/// The vertices of the boundary, along the coarse edges.
void set_boundary(const DiskMesh& coarse, const std::vector<Index>& fine_vertex,
                  const DiskMesh& fine, std::vector<Footpoint>& points) {
  std::vector<Index> coarse_of(fine.vertex_count(), kNone);
  for (const Index c : coarse.boundary) coarse_of[fine_vertex[c]] = c;
  const std::vector<Index>& loop = fine.boundary;
  const std::vector<double> lengths = boundary_lengths(fine);
  const Index count = size_of(loop);
  const auto next = [count](Index i) { return i + 1 == count ? 0 : i + 1; };
  Index start = 0;
  while (coarse_of[loop[start]] == kNone) ++start;
  Index i = start;
  do {
    const Index from = coarse_of[loop[i]];
    double total = lengths[i];
    Index end = next(i);
    for (; coarse_of[loop[end]] == kNone; end = next(end)) total += lengths[end];
    points[loop[i]] = at_vertex(coarse, from);
    const Index edge = boundary_halfedge(coarse, from);
    double along = lengths[i];
    for (Index k = next(i); k != end; k = next(k)) {
      points[loop[k]] = {edge, {static_cast<float>(along / total), 0}};
      along += lengths[k];
    }
    i = end;
  } while (i != start);
}

/// The closest point of the faces around a coarse vertex.
SurfacePoint closest_around(const DiskMesh& coarse, Index home, const Vec3& point) {
  SurfacePoint best;
  best.distance_sq = std::numeric_limits<double>::infinity();
  Index h = coarse.outgoing[home];
  for (int seen = 0; h != kNone && seen < kMostFaces; ++seen) {
    const Triangle& t = coarse.faces[h / 3];
    const Vec3 &a = coarse.positions[t[0]], &b = coarse.positions[t[1]],
               &c = coarse.positions[t[2]];
    const auto at = closest_on_triangle(point, a, b, c);
    const double distance_sq = (at[0] * a + at[1] * b + at[2] * c - point).squaredNorm();
    if (distance_sq < best.distance_sq) best = {h / 3, at, distance_sq};
    h = coarse.rotate(h);
    if (h == coarse.outgoing[home]) break;
  }
  return best;
}

Footpoint on_face(const SurfacePoint& at) {
  return {3 * at.face,
          {static_cast<float>(at.barycentric[1]), static_cast<float>(at.barycentric[2])}};
}

bool touches(const DiskMesh& mesh, Index face, Index v) {
  if (face == kNone) return false;
  const Triangle& t = mesh.faces[face];
  return t[0] == v || t[1] == v || t[2] == v;
}

/// The sum of the normals of its faces, weighted by area.
Vec3 normal_at(const DiskMesh& mesh, Index v) {
  const Vec3& origin = mesh.positions[v];
  Vec3 sum = Vec3::Zero();
  mesh.for_each_outgoing(v, [&](Index h) {
    const Triangle& t = mesh.faces[h / 3];
    const Vec3& a = mesh.positions[t[next_corner(h % 3)]];
    const Vec3& b = mesh.positions[t[previous_corner(h % 3)]];
    sum += (a - origin).cross(b - origin);
  });
  return sum;
}

}  // namespace

std::vector<Footpoint> footpoints(const DiskMesh& coarse, const std::vector<Index>& fine_vertex,
                                  const std::vector<Index>& nearby, const DiskMesh& fine,
                                  const Work& work) {
  std::vector<Footpoint> points;
  parallel_assign(work, points, fine.positions.size());
  const SurfaceWalk walk(coarse, work);
  parallel_for(work, fine.vertex_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Index last = kNone;  // the face found last, near the next vertex more often than not
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (fine.on_boundary[v]) continue;
      const Index home = nearby[v];
      points[v] = at_vertex(coarse, home);
      if (fine_vertex[home] == v) continue;
      const Vec3& point = fine.positions[v];
      const Index start = touches(coarse, last, home) ? last : coarse.outgoing[home] / 3;
      SurfacePoint hit = walk.find(point, normal_at(fine, v), start);
      if (hit.face == kNone) hit = closest_around(coarse, home, point);
      if (hit.face != kNone) points[v] = on_face(hit);
      last = hit.face;
    }
  });
  set_boundary(coarse, fine_vertex, fine, points);
  return points;
}

}  // namespace beltrami
