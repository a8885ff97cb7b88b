// The fine map from the whole prolonged metric: one Poisson solve, rotations re-fitted with the
// same factor. Free boundary: nothing is taken from the coarse map but its metric, and the places
// of vertices that are held on purpose.
#pragma once

#include <memory>
#include <vector>

#include "base/checkpoint.h"
#include "base/types.h"
#include "beltrami/prolongation.h"
#include "distortion/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "sparse/mesh_matrix.h"
#include "sparse/spd_solver.h"

namespace beltrami {

/// A Laplacian of the mesh with one stiffness tensor per face and some vertices held, and its
/// factor.
class MetricLaplacian {
 public:
  /// The Laplacian of a metric, weighted by 3D area. Times the curvature of an energy density at
  /// the identity it approximates the Hessian of the sum of that energy at a map that has the
  /// metric. `held`: per vertex; at least one must be. Throws Error SOLVER.
  MetricLaplacian(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const std::vector<bool>& held,
                  const SolverOptions& options = {Precision::kSingle});

  /// Factorizes anew for an approximate Hessian of the sum of `energy` at the map `uvs`: per face
  /// the mean of the Hessian's radial and angular parts along each singular direction, the same for
  /// u and v. Far closer to the Hessian than the metric alone where a face is much distorted.
  /// Throws Error SOLVER.
  void refit(Energy energy, const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
             const std::vector<Vec2>& uvs, int threads);

  /// Solves L x = rhs; both one row per vertex, x zero at the held vertices.
  DenseMatrix solve(const DenseMatrix& rhs) const;
  /// The same roughly, at half the cost: see SpdSolver::precondition.
  DenseMatrix precondition(const DenseMatrix& rhs) const;

 private:
  DenseMatrix apply(const DenseMatrix& rhs,
                    DenseMatrix (SpdSolver::*inverse)(const DenseMatrix&) const) const;

  MeshMatrix matrix_;
  std::unique_ptr<SpdSolver> solver_;
};

/// Minimises the area-weighted relative deviation from the target edges X z + Y conj(z) of every
/// face (Y = mu X), then alternates `rotations` times between the best rotation of each target
/// (Liu et al. 2008, local step) and a solve. `uvs`, one per vertex, is changed in place; vertices
/// that `laplacian` holds keep their place, of the others nothing is used. Faces may be flipped.
/// `laplacian` must be that of the metric.
void solve_metric(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const MetricLaplacian& laplacian,
                  int rotations, int threads, std::vector<Vec2>& uvs,
                  const Checkpoint& checkpoint = no_checkpoint);

}  // namespace beltrami
