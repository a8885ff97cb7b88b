// One face under maps of given singular values: a density in its six coordinates.
#pragma once

#include <Eigen/Eigenvalues>
#include <complex>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "descend/assembly.h"
#include "mesh/rest_shape.h"

namespace beltrami::faces {

inline const RestTriangle kRest{1.3, 0.4, 0.9};

/// The corners under the map with the given singular values and arbitrary phases.
inline Vector6 corners_of(double s1, double s2) {
  const Complex fz = std::polar(0.5 * (s1 + s2), 0.7);
  const Complex fzbar = std::polar(0.5 * (s1 - s2), -1.9);
  Vector6 x;
  for (int k = 0; k < 3; ++k) {
    const Complex z = kRest.corner(k), w = fz * z + fzbar * std::conj(z) + Complex(0.2, -0.1);
    x.segment<2>(2 * k) << w.real(), w.imag();
  }
  return x;
}

inline LinearMap map_of(const Vector6& x) {
  return linear_map(kRest, x.segment<2>(0), x.segment<2>(2), x.segment<2>(4));
}

template <class Density>
double energy_of(const Vector6& x) {
  const SingularValues s = singular_values(map_of(x));
  return Density::value(s.s1, s.s2);
}

template <class Density>
FaceModel model_of(const Vector6& x, const Density& density) {
  const std::vector<Vec2> uvs = {x.segment<2>(0), x.segment<2>(2), x.segment<2>(4)};
  FaceModels models;
  give_face_models(
      {{0, 1, 2}}, {kRest}, uvs, 0, 1, density, [](auto) { return 1.0; }, models);
  return models.at(0);
}

/// Of the gradients of the model, `h` apart in each coordinate.
template <class Density>
Matrix6 hessian_by_differences(const Vector6& x, double h) {
  Matrix6 hessian;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = h * Vector6::Unit(i);
    hessian.col(i) = (model_of(Vector6(x + step), Density{}).gradient -
                      model_of(Vector6(x - step), Density{}).gradient) /
                     (2 * h);
  }
  return 0.5 * (hessian + hessian.transpose());
}

inline double least_eigenvalue(const Matrix6& m) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(m).eigenvalues()[0];
}

}  // namespace beltrami::faces
