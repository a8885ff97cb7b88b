#include "prolong/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/parallel.h"
#include "base/types.h"
#include "mesh/rest_shape.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
constexpr int kMaxSteps = 40;
constexpr double kFar = 0.25;  // of the longest edge, squared

}  // namespace

SurfaceWalk::SurfaceWalk(const DiskMesh& mesh, const Work& work) : mesh_(mesh) {
  parallel_assign(work, planes_, mesh.faces.size());
  parallel_for(work, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      const Triangle& t = mesh.faces[f];
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 u = b - a, w = c - a;
      Vec3 normal = u.cross(w);
      const double longest_sq = std::max({u.squaredNorm(), w.squaredNorm(), (c - b).squaredNorm()});
      if (is_degenerate(a, b, c)) {
        planes_[f].longest_sq = -1;
        continue;
      }
      const double inverse_sq = 1 / normal.squaredNorm();
      const Vec3 dual1 = inverse_sq * w.cross(normal), dual2 = inverse_sq * normal.cross(u);
      Plane& plane = planes_[f];
      plane.corner = a;
      plane.dual1 = dual1;
      plane.dual2 = dual2;
      plane.normal = normal * std::sqrt(inverse_sq);
      plane.longest_sq = longest_sq;
    }
  });
}

SurfacePoint SurfaceWalk::find(const Vec3& point, const Vec3& normal, Index start) const {
  Index previous = kNone;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Plane& plane = planes_[start];
    if (plane.longest_sq < 0) break;
    const Vec3 d = point - plane.corner;
    const double b1 = plane.dual1.dot(d), b2 = plane.dual2.dot(d), b0 = 1 - b1 - b2;
    SurfacePoint hit{start, {b0, b1, b2}, 0};
    int least = b0 < b1 ? (b0 < b2 ? 0 : 2) : (b1 < b2 ? 1 : 2);
    if (hit.barycentric[least] < 0) {
      const Index across = mesh_.twin[3 * start + next_corner(least)];
      if (across == kNone) break;
      if (across / 3 != previous) {
        previous = start;
        start = across / 3;
        continue;
      }
      // Over the ridge between the two faces.
      const Triangle& t = mesh_.faces[start];
      hit.barycentric = closest_on_triangle(point, mesh_.positions[t[0]], mesh_.positions[t[1]],
                                            mesh_.positions[t[2]]);
    }
    const double off = plane.normal.dot(d);
    hit.distance_sq = off * off;
    if (!(plane.normal.dot(normal) > 0) || hit.distance_sq > kFar * plane.longest_sq) break;
    return hit;
  }
  return {};
}

}  // namespace beltrami
