// The fine map straight from the coarse boundary: harmonic in the metric of the prolonged Beltrami
// coefficients (paper section 3.4), with the boundary taken from the coarse map.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "flatten/laplacian.h"
#include "mesh/disk_mesh.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Places each fine boundary vertex on the edge of the coarse boundary polygon that replaced it, by
/// arc length between the two fine vertices that survived. Returns one UV per fine vertex, zero in
/// the interior.
std::vector<Vec2> carry_boundary(const DiskMesh& fine, const CoarseDisk& coarse,
                                 const std::vector<Vec2>& coarse_uvs);

/// Solves for the interior vertices, harmonic in the metric of the corner `cotangents`, with the
/// boundary vertices of `uvs` held fixed, in place: one factorization, two right-hand sides. Throws
/// Error SOLVER.
void solve_harmonic(const DiskMesh& mesh, const std::vector<Cotangents>& cotangents,
                    std::vector<Vec2>& uvs, const Work& work);

/// Per edge of the fine boundary loop: the length on the surface of the coarse boundary edge that
/// it belongs to, > 0.
std::vector<double> coarse_boundary_lengths(const DiskMesh& fine, const CoarseDisk& coarse);

}  // namespace beltrami
