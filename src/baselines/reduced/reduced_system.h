// The dense system of a Newton step in the meta vertices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/assembly.h"
#include "linear/spd_solver.h"

namespace beltrami {

/// Of n meta vertices: (2 n, 2 n), its lower triangle, and (2 n); u of all, then v.
struct ReducedSystem {
  DenseMatrix hessian;
  Eigen::VectorXd gradient;
};

/// Samples: E^T D E with the edges E and, per sample, the 4 x 4 block D of its corners 1 and 2,
/// since an energy does not see translations. `edges`, (2 s, n): of all s samples, per meta vertex.
/// `active`: the samples that count, ascending. `faces` and `models`: those of them, then those of
/// the scaffold, on points of which 0 is the origin; the edges, the meta vertices and the circle
/// follow. Throws std::bad_alloc.
ReducedSystem assemble_reduced(const DenseMatrix& edges, const std::vector<Index>& active,
                               const std::vector<Triangle>& faces,
                               const std::vector<FaceModel>& models, Index metas, const Work& work);

/// The Newton direction. A shift relative to the diagonal covers what is free or within the
/// roundoff; it stays in the Hessian. Empty where none makes the system definite.
std::vector<Vec2> newton_direction(ReducedSystem& system);

}  // namespace beltrami
