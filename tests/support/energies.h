// The energies of a delivered map.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "energy/energy.h"
#include "energy/exponential_dirichlet.h"
#include "support/meshes.h"

namespace beltrami::disks {

inline constexpr Energy kEnergies[] = {Energy::kSymmetricDirichlet, Energy::kSymmetricArap,
                                       Energy::kExponentialDirichlet};

/// The mean exponential symmetric Dirichlet energy, over the faces that have an energy.
inline double mean_exponential(const meshes::TriangleList& mesh, const Flattening& result) {
  double sum = 0, total = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!std::isfinite(result.face_energies[f])) continue;
    const Triangle& t = mesh.faces[f];
    const Vec3 p = mesh.positions[t[0]], a = mesh.positions[t[1]] - p, b = mesh.positions[t[2]] - p;
    const double area = 0.5 * a.cross(b).norm();
    sum += area * ExponentialDirichlet::from_dirichlet(result.face_energies[f]);
    total += area;
  }
  return sum / total;
}

/// The mean of an energy, counted as symmetric Dirichlet: from 2 at the isometries.
inline double distortion(Energy which, const meshes::TriangleList& mesh, const Flattening& result) {
  switch (which) {
    case Energy::kSymmetricArap:
      return to_dirichlet(which, result.distortion.symmetric_arap);
    case Energy::kExponentialDirichlet:
      return to_dirichlet(which, mean_exponential(mesh, result));
    default:
      return result.distortion.symmetric_dirichlet;
  }
}

}  // namespace beltrami::disks
