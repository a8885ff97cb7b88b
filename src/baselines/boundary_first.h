// Boundary first flattening (Sawhney & Crane 2017, "Boundary First Flattening") in the metric of
// prolonged Beltrami coefficients: the boundary curve follows from its lengths, the interior from
// the curve. Linear throughout: one factorization, three solves.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"

namespace beltrami {

struct BoundaryFirstResult {
  std::vector<Vec2> uvs;  ///< one per vertex; boundary[0] at the origin, the first edge along +x
  /// How far the boundary missed to close before it was closed, relative to its length. Near 0 the
  /// lengths were compatible with the metric; from about 0.1 on expect strong distortion.
  double closure_defect = 0;
};

/// Flattens conformally in the metric |dz + mu conj(dz)|^2 of `metric`, one per face; its area
/// factors choose, within the conformal class, the lengths that curvatures are measured with, so
/// that the metric of a map gives that map. The identity metric with the lengths in space is plain
/// boundary first flattening with scale factor 1
/// on the boundary. `boundary_lengths`: the target length of each boundary edge in loop order, edge
/// i from boundary[i] to boundary[i + 1]; all positive. They set the scale of the result, and are
/// met up to the factors that close the curve. Nothing guarantees injectivity: faces may be flipped
/// and the boundary may cross itself. Throws Error SOLVER.
BoundaryFirstResult flatten_boundary_first(const DiskMesh& mesh,
                                           const std::vector<RestTriangle>& rest,
                                           const std::vector<FaceMetric>& metric,
                                           const std::vector<double>& boundary_lengths,
                                           const Work& work);

/// The lengths that `metric` asks for at the boundary: of each boundary edge, in loop order, under
/// the linear map fz z + mu fz conj(z) of its face. All positive; the identity metric gives the
/// lengths in space.
std::vector<double> metric_boundary_lengths(const DiskMesh& mesh,
                                            const std::vector<RestTriangle>& rest,
                                            const std::vector<FaceMetric>& metric);

}  // namespace beltrami
