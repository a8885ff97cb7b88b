// The fine map from the whole prolonged metric: one Poisson solve, rotations re-fitted with the
// same factor. Free boundary: nothing is taken from the coarse map but its metric, and the places
// of vertices that are anchored on purpose.
#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "flatten/laplacian.h"
#include "flatten/stiffness_inverse.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"

namespace beltrami {

/// Stiffness of every face that approximates the Hessian of the integral of `energy` over it at a
/// map that has the metric: per face the mean of the Hessian's radial and angular parts along each
/// singular direction, the same for u and v.
std::vector<EdgeWeights> energy_stiffness(Energy energy, const std::vector<RestTriangle>& rest,
                                          const std::vector<FaceMetric>& metric, const Work& work);

/// The same at the map `uvs`.
std::vector<EdgeWeights> energy_stiffness(Energy energy, const std::vector<Triangle>& faces,
                                          const std::vector<RestTriangle>& rest,
                                          const std::vector<Vec2>& uvs, const Work& work);

/// That of some faces at a time. Keeps references to what it gets.
StiffnessOfFaces stiffness_of_faces(Energy energy, const std::vector<Triangle>& faces,
                                    const std::vector<RestTriangle>& rest,
                                    const std::vector<Vec2>& uvs);

/// Springs that draw vertices to places of their own.
struct Anchors {
  std::vector<double> springs;  ///< per vertex: stiffness, 0 where there is none; empty: all are
  std::vector<Vec2> places;     ///< per vertex
};

/// Of stiff springs, in sums of the weights around: the vertices end nearer to their places than to
/// each other, and a factor in single precision takes no harm.
inline constexpr double kStiffSpring = 10;

/// Springs for the given vertices, far stiffer than the faces around them.
std::vector<double> stiff_springs(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
                                  const std::vector<bool>& vertices);

/// A Laplacian of the mesh with given stiffness, springs at vertices and some vertices held, and
/// its factor. Keeps a reference to the faces of the mesh.
class MetricLaplacian final : public StiffnessInverse {
 public:
  /// `held`: per vertex; at least one must be. `springs`: per vertex, or empty. Throws Error
  /// SOLVER.
  MetricLaplacian(const DiskMesh& mesh, const std::vector<EdgeWeights>& stiffness,
                  const std::vector<bool>& held, const SolverOptions& options,
                  const std::vector<double>& springs, const Work& work);

  /// Factorizes anew. Throws Error SOLVER.
  void refit(const StiffnessOfFaces& stiffness, const std::vector<double>& springs) override;
  void refit(const std::vector<EdgeWeights>& stiffness, const std::vector<double>& springs);

  /// Solves L x = rhs; both one row per vertex, x zero at the held vertices.
  DenseMatrix solve(const DenseMatrix& rhs) const;
  void solve(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) const;
  /// The same roughly, at half the cost: see SpdSolver::precondition.
  void precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) override;

 private:
  void assemble(const std::vector<EdgeWeights>& stiffness, const std::vector<double>& springs);
  template <class Rows>
  DenseMatrix packed(const Rows& rhs) const;
  template <class Rows>
  void unpack(const DenseMatrix& x, Rows&& result) const;

  const std::vector<Triangle>& faces_;
  MeshMatrix matrix_;
  const Work work_;
  std::unique_ptr<SpdSolver> solver_;
};

/// Minimises the deviation from the target edges X z + Y conj(z) of every face (Y = mu X) in the
/// norm of `stiffness`; with `rotate`, each target is turned first to fit the present `uvs` best
/// (Liu et al. 2008, local step). Where the stiffness is that of an energy at the metric, this is
/// near to a Newton step of that energy. `uvs`, one per vertex, is changed in place; vertices that
/// `laplacian` holds keep their place, of the others nothing is used but for `rotate`. Faces may be
/// flipped. `laplacian` must be that of the stiffness and of the anchors.
void solve_metric(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const std::vector<EdgeWeights>& stiffness,
                  const MetricLaplacian& laplacian, const Anchors& anchors, bool rotate,
                  std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
