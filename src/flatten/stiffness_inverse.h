// What preconditions the descent of a map: about the inverse of a stiffness.
#pragma once

#include <vector>

#include "base/types.h"
#include "flatten/laplacian.h"

namespace beltrami {

/// About the inverse of a Laplacian with springs at its vertices: linear, symmetric, definite.
class StiffnessInverse {
 public:
  virtual ~StiffnessInverse() = default;
  /// Takes another stiffness, one entry per face, and springs, per vertex or none. Throws Error
  /// SOLVER.
  virtual void refit(const std::vector<EdgeWeights>& stiffness,
                     const std::vector<double>& springs) = 0;
  /// Sets `x` to it times `rhs`; one entry per vertex.
  virtual void precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) = 0;
};

}  // namespace beltrami
