// How much worse a collapse may leave the faces around it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// What a collapse may do to the shape of the faces around it.
struct ShapeLimits {
  double min_turn_cosine;    ///< between the normals of a face before and after
  double min_quality;        ///< a face at least this good (1 is equilateral) is always accepted
  double min_quality_ratio;  ///< below that: the worst new face over the worst old one
  double min_progress;  ///< collapses per candidate in a pass, below which the next limits follow
};

/// From strict to lax. The quality is relative, since an absolute bound stalls on meshes that are
/// made of slivers; a stricter one than the first stalls on good meshes, and what follows then
/// ruins them. Passes that trickle cost a full sweep for a handful of vertices.
inline constexpr ShapeLimits kShapeLimits[] = {
    {0.5, 0.35, 0.9, 0.01},
    {0.5, 0.2, 0.7, 0.01},
    {0.2, 0.1, 0.4, 0.01},
    {-0.5, 0.02, 0.1, 0.0005},
};

/// Area over the sum of squared edge lengths, scaled to 1 for an equilateral triangle.
inline double shape_quality(double twice_area, double squared_lengths) {
  return squared_lengths > 0 ? 3.4641016151377544 * twice_area / squared_lengths : 0;
}

/// Whether collapsing v onto the target stays within the limits. `surface.position(v)` is a Vec3,
/// and `surface.for_each_corner(v, visit)` calls visit(face, corner, next vertex, previous vertex)
/// for each face of v.
template <class Surface>
bool keeps_shape(const Surface& surface, Index v, Index target, const ShapeLimits& limits) {
  const Vec3& from = surface.position(v);
  const Vec3& to = surface.position(target);
  Vec3 fan_normal = Vec3::Zero();
  double worst_before = 1;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    const Vec3 u = surface.position(a) - from, w = surface.position(b) - from;
    const Vec3 normal = u.cross(w);
    fan_normal += normal;
    const double lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    worst_before = std::min(worst_before, shape_quality(normal.norm(), lengths));
  });
  const double worst_allowed =
      std::min(limits.min_quality, limits.min_quality_ratio * worst_before);

  bool kept = true;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    if (!kept || a == target || b == target) return;
    const Vec3& pa = surface.position(a);
    const Vec3& pb = surface.position(b);
    const Vec3 u = pa - to, w = pb - to;
    const Vec3 after = u.cross(w);
    const double twice_area = after.norm();
    const double lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    Vec3 before = (pa - from).cross(pb - from);
    double before_norm = before.norm();
    // A degenerate face has no normal of its own to keep.
    if (!(before_norm > 0)) {
      before = fan_normal;
      before_norm = before.norm();
    }
    kept = shape_quality(twice_area, lengths) >= worst_allowed &&
           before.dot(after) >= limits.min_turn_cosine * before_norm * twice_area;
  });
  return kept;
}

}  // namespace beltrami
