// Rays that meet a triangle mesh.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/closest_point.h"
#include "mesh/face_tree.h"

namespace beltrami {

/// Where a ray begins, its direction of length 1, and how far it goes: a finite number.
struct Ray {
  Vec3 origin, direction;
  double reach = 0;
};

/// Answers what rays meet, on a mesh that it keeps references to, as to its tree. Queries are const
/// and may come from several threads.
class Rays {
 public:
  Rays(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
       const FaceTree& tree);

  /// The first place that a ray meets of a face that it comes to from outside, where the corners
  /// turn to the left; its face is kNone if there is none. Equal distances go to the smaller face.
  /// An edge belongs to both of its faces, so that no ray slips through between them.
  SurfacePoint first_from_outside(const Ray& ray) const;

  /// Whether a ray meets a face, from either side.
  bool is_stopped(const Ray& ray) const;

 private:
  /// Calls `visit(face, distance, barycentric)` for each face that a ray meets before `reach`,
  /// which it returns anew: a negative one ends the search.
  template <class Visit>
  void search(const Ray& ray, const Visit& visit) const;

  const std::vector<Vec3>& positions_;
  const std::vector<Triangle>& faces_;
  const FaceTree& tree_;
};

}  // namespace beltrami
