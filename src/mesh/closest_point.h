// Closest points on a triangle mesh.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/face_tree.h"

namespace beltrami {

/// A point of a face, by barycentric coordinates that are non-negative and sum to 1.
struct SurfacePoint {
  Index face = kNone;
  std::array<double, 3> barycentric = {1, 0, 0};
  double distance_sq = 0;
};

/// Answers closest-point queries on a mesh of one face or more, finite, that it keeps references
/// to. Queries are const and may come from several threads.
class ClosestPoint {
 public:
  ClosestPoint(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces);

  /// The closest point on faces whose normal has a positive product with `normal`, so that the far
  /// side of a thin sheet is not taken; on all faces if there is none. Equal distances go to the
  /// smaller face. `seed` (a face, or kNone) bounds the search and does not change its result.
  SurfacePoint find(const Vec3& point, const Vec3& normal, Index seed) const;

  /// The same, but only on those faces and no further than `reach`; its face is kNone if there is
  /// none.
  SurfacePoint find_within(const Vec3& point, const Vec3& normal, double reach, Index seed) const;

  /// The diagonal of the box around the faces.
  double size() const { return tree_.nodes[0].box.diagonal().norm(); }

  const FaceTree& tree() const { return tree_; }

 private:
  SurfacePoint search(const Vec3& point, const Vec3* normal, double reach_sq, Index seed) const;
  void consider(const Vec3& point, const Vec3* normal, Index face, SurfacePoint& best) const;

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& faces_;
  std::vector<Vec3> normals_;  // not normalised: only signs are asked for
  FaceTree tree_;
};

/// The point of triangle (a, b, c) that is closest to p (Ericson, Real-Time Collision Detection,
/// 5.1.5), as barycentric coordinates. Degenerate triangles are fine.
std::array<double, 3> closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                          const Vec3& c);

}  // namespace beltrami
