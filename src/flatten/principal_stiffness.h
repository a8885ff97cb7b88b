// How stiff an energy is along the singular directions of a map, whichever way it moves.
#pragma once

#include <algorithm>

#include "energy/density.h"

namespace beltrami {

/// Along the direction of the greater singular value, and across it.
struct PrincipalStiffness {
  double along, across;
};

/// At singular values a + b and a - b: along each the mean of the density's radial curvature there
/// and of its angular ones.
template <class Density>
PrincipalStiffness principal_stiffness(double a, double b) {
  const DensityModel model = Density::model(a + b, a - b);
  // Beside a ridge of the density the angular curvature is without bounds.
  const double angular = std::min(0.5 * (model.twist + model.flip), model.h11 + model.h22);
  return {0.5 * (model.h11 + angular), 0.5 * (model.h22 + angular)};
}

}  // namespace beltrami
