// Beltrami coefficients of a coarse map and their prolongation to a fine mesh (paper section 3.3).
#pragma once

#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// The metric that a map induces on a face, in the frame whose real axis is the face's edge from
/// corner 0 to corner 1.
struct FaceMetric {
  Complex mu = 0;       ///< Beltrami coefficient fzbar / fz; |mu| < 1 where orientation is kept
  double log_area = 0;  ///< logarithm of the area factor |fz|^2 - |fzbar|^2
  Complex phase = 1;    ///< fz / |fz|

  Complex fz() const {
    return phase * portable::exp(0.5 * log_area) / std::sqrt(1 - std::norm(mu));
  }
};

/// The metric of every face under `uvs`; the identity's where a face is not positively oriented.
std::vector<FaceMetric> face_metrics(const std::vector<Triangle>& faces,
                                     const std::vector<RestTriangle>& rest,
                                     const std::vector<Vec2>& uvs);

/// Carries the metric of the coarse faces over to the fine faces: averaged by area in the tangent
/// planes of the coarse vertices, interpolated at the point that is closest to each fine centroid,
/// and transported into the frame of the fine face. A convex combination throughout: |mu| never
/// exceeds the greatest coarse one. Faces without a normal get mu = 0. `nearby`: per fine vertex a
/// coarse vertex near it on the surface, which saves a search over all faces and keeps to the right
/// side of a seam; or empty.
std::vector<FaceMetric> prolong_metric(const DiskMesh& coarse,
                                       const std::vector<FaceMetric>& metrics, const DiskMesh& fine,
                                       const std::vector<Index>& nearby, const Work& work);

}  // namespace beltrami
