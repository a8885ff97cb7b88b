// What preconditions the descent of a map: about the inverse of a stiffness.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/vectors.h"
#include "energy/energy.h"
#include "flatten/laplacian.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Writes the stiffness of the faces from `first` on, `end - first` of them; any ranges, from
/// several threads at once. Of a large mesh the stiffness of all faces at once is more than what is
/// kept of it in single precision.
using StiffnessOfFaces =
    std::function<void(std::int64_t first, std::int64_t end, EdgeWeights* weights)>;

/// About the inverse of a Laplacian with springs at its vertices: linear, symmetric, definite.
class StiffnessInverse {
 public:
  virtual ~StiffnessInverse() = default;
  /// Takes another stiffness, which is not asked later, and springs, per vertex or none. Throws
  /// Error SOLVER.
  virtual void refit(const StiffnessOfFaces& stiffness, const std::vector<double>& springs) = 0;
  /// Takes the Hessian of the energy at this map, of positive faces, where it can do with that
  /// beside the stiffness and it is cheap enough. Returns whether it has.
  virtual bool take_hessian(Energy, const std::vector<RestTriangle>&, const std::vector<Vec2>&) {
    return false;
  }
  /// Sets `x` to it times `rhs`; one entry per vertex.
  virtual void precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) = 0;
};

}  // namespace beltrami
