// A factor of the Hessian of an energy at a map, as composite majorization has it: what a descent
// on a finer mesh is preconditioned with where a stiffness is not good enough.
#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Of the integral of the energy over the mesh, with one vertex of the boundary held. A stiffness
/// is the same for u and v; this knows how they go together, and so along which motions of the
/// whole map the energy hardly changes (Shtengel et al. 2017, "Geometric Optimization via Composite
/// Majorization").
class HessianFactor {
 public:
  /// Keeps a reference to the mesh.
  HessianFactor(const DiskMesh& mesh, const Work& work);

  /// Takes the Hessian at this map; `rest`: one per face; `uvs`: one per vertex, all faces
  /// positive. Returns whether there is a factor: in floating point the matrix may not be definite.
  bool fit(Energy energy, const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs);

  /// Frees what only the next fit() is faster with, and keeps a factor in single precision in 16
  /// bits per entry. A small one, in double precision, stays as it is.
  void settle();

  /// Sets `x` to about its inverse times `rhs`; one entry per vertex. Linear, symmetric, definite.
  /// Precondition: the last fit() found one.
  void precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) const;

 private:
  const DiskMesh& mesh_;
  const Work work_;
  bool analyzed_ = false;
  std::vector<Index> row_;  ///< per vertex, or kNone
  Index rows_ = 0;          ///< of two numbers each
  std::unique_ptr<SpdSolver> solver_;
};

}  // namespace beltrami
