// Closest points on a disk from a start that is near, without a tree.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/closest_point.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Walks from face to face over the edge that a point lies farthest outside of, until it lies above
/// a face or over the ridge between two. Keeps a reference to the mesh.
class SurfaceWalk {
 public:
  SurfaceWalk(const DiskMesh& mesh, const Work& work);

  /// The point below `point`, starting at face `start`. Its face is kNone where the walk gets
  /// nowhere: after a few dozen faces, far from the surface (by the size of the face), at the
  /// boundary, or on a face whose normal has no positive product with `normal`.
  SurfacePoint find(const Vec3& point, const Vec3& normal, Index start) const;

 private:
  /// What turns a point into barycentric coordinates: 1 and 2 are products with `dual`, off the
  /// corner 0.
  struct Plane {
    Vec3 corner, dual1, dual2, normal;
    double longest_sq;  ///< the longest edge; negative where the face has no normal

    Plane() {}  // leaves a large array as it is
  };

  const DiskMesh& mesh_;
  std::vector<Plane> planes_;
};

}  // namespace beltrami
