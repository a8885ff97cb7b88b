// The fine map from the whole prolonged metric: one Poisson solve, rotations re-fitted with the
// same factor. Free boundary: nothing is taken from the coarse map but its metric, and the places
// of vertices that are held on purpose.
#pragma once

#include <memory>
#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "beltrami/prolongation.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "sparse/mesh_matrix.h"
#include "sparse/spd_solver.h"

namespace beltrami {

/// The Laplacian of a prolonged metric, weighted by 3D area, with some vertices held, and its
/// factor. 1/4 of the inverse times the total area approximates the inverse Hessian of the mean
/// symmetric Dirichlet energy at a map that has the metric, so the same factor preconditions the
/// polish.
class MetricLaplacian {
 public:
  /// Assembles and factorizes. `held`: per vertex; at least one must be. Throws Error SOLVER.
  MetricLaplacian(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const std::vector<bool>& held,
                  const SolverOptions& options = {Precision::kSingle});

  /// Solves L x = rhs; both one row per vertex, x zero at the held vertices.
  DenseMatrix solve(const DenseMatrix& rhs) const;
  /// The same roughly, at half the cost: see SpdSolver::precondition.
  DenseMatrix precondition(const DenseMatrix& rhs) const;

 private:
  DenseMatrix apply(const DenseMatrix& rhs,
                    DenseMatrix (SpdSolver::*inverse)(const DenseMatrix&) const) const;

  std::vector<Index> row_;
  std::unique_ptr<SpdSolver> solver_;
  Index free_count_ = 0;
};

/// Minimises the area-weighted relative deviation from the target edges X z + Y conj(z) of every
/// face (Y = mu X), then alternates `rotations` times between the best rotation of each target
/// (Liu et al. 2008, local step) and a solve. `uvs`, one per vertex, is changed in place; vertices
/// that `laplacian` holds keep their place, of the others nothing is used. Faces may be flipped.
void solve_metric(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const MetricLaplacian& laplacian,
                  int rotations, int threads, std::vector<Vec2>& uvs,
                  const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
