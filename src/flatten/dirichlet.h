// The fine map straight from the coarse boundary: harmonic in the metric of the prolonged Beltrami
// coefficients (paper section 3.4), with the boundary taken from the coarse map.
#pragma once

#include <vector>

#include "base/types.h"
#include "beltrami/prolongation.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "simplify/simplify.h"

namespace beltrami {

/// Places each fine boundary vertex on the edge of the coarse boundary polygon that replaced it, by
/// arc length between the two fine vertices that survived. Returns one UV per fine vertex, zero in
/// the interior.
std::vector<Vec2> carry_boundary(const DiskMesh& fine, const CoarseDisk& coarse,
                                 const std::vector<Vec2>& coarse_uvs);

/// Cotangents at the three corners of a face in the metric |dz + mu conj(dz)|^2.
/// Precondition: |mu| < 1. (Paper section 3.4: cot = -Re q / Im q with
/// q = (v1 + mu conj(v1)) conj(v2 + mu conj(v2)).)
std::array<double, 3> modified_cotangents(const RestTriangle& rest, Complex mu);

/// Solves for the interior vertices, harmonic in the conformal class of `metric` (its mu alone),
/// with the boundary vertices of `uvs` held fixed, in place: one factorization, two right-hand
/// sides. Negative weights are kept; the matrix is definite all the same, being the stiffness
/// matrix of a metric. Throws Error SOLVER.
void solve_harmonic(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const std::vector<FaceMetric>& metric, std::vector<Vec2>& uvs, int threads = 1);

}  // namespace beltrami
