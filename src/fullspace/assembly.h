// Energy, gradient and projected Hessian of a density over a set of faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "distortion/density.h"
#include "mesh/rest_shape.h"
#include "sparse/mesh_matrix.h"

namespace beltrami {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Gradient and Hessian model of one face in its six coordinates (u0, v0, u1, v1, u2, v2).
struct FaceModel {
  Vector6 gradient;
  Matrix6 hessian;
};

/// Signed singular values of a linear map. s2 comes from the determinant where |fz| - |fzbar| would
/// cancel.
struct SingularValues {
  double s1, s2;
};
inline SingularValues singular_values(const LinearMap& map) {
  const double a = modulus(map.fz), b = modulus(map.fzbar);
  const double s1 = a + b;
  return {s1, s1 > 0 ? (std::norm(map.fz) - std::norm(map.fzbar)) / s1 : 0.0};
}

/// Chain rule from the density model to the corners: fz and fzbar are linear in them, with
/// coefficients conj(G_k) / 2 and G_k / 2 for the hat gradients G_k.
template <class Density>
FaceModel face_model(const RestTriangle& rest, const LinearMap& map, const Density& density) {
  const SingularValues s = singular_values(map);
  const DensityModel m = density.model(s.s1, s.s2);
  const double a = modulus(map.fz), b = modulus(map.fzbar);
  const Complex phase_x = a > 0 ? std::conj(map.fz) / a : Complex(1);
  const Complex phase_y = b > 0 ? std::conj(map.fzbar) / b : Complex(1);
  Vector6 radial_x, twist, radial_y, flip;
  for (int k = 0; k < 3; ++k) {
    const Complex gradient = rest.hat_gradient(k);
    const Complex p = 0.5 * phase_x * std::conj(gradient), q = 0.5 * phase_y * gradient;
    radial_x.segment<2>(2 * k) << p.real(), -p.imag();
    twist.segment<2>(2 * k) << p.imag(), p.real();
    radial_y.segment<2>(2 * k) << q.real(), -q.imag();
    flip.segment<2>(2 * k) << q.imag(), q.real();
  }
  const Vector6 g1 = radial_x + radial_y, g2 = radial_x - radial_y;
  FaceModel model;
  model.gradient = m.d1 * g1 + m.d2 * g2;
  model.hessian.noalias() = (m.h11 * g1 + m.h12 * g2) * g1.transpose();
  model.hessian.noalias() += (m.h12 * g1 + m.h22 * g2) * g2.transpose();
  model.hessian.noalias() += (m.twist * twist + m.coupling * flip) * twist.transpose();
  model.hessian.noalias() += (m.coupling * twist + m.flip * flip) * flip.transpose();
  return model;
}

/// Adds up a density over all faces, weighted by `weight(face)`. Faces are modelled in parallel and
/// scattered in order, so the bits do not depend on the number of threads.
template <class Density, class Weight>
void assemble(const std::vector<Triangle>& faces, const std::vector<RestTriangle>& rest,
              const std::vector<Vec2>& uvs, const Density& density, const Weight& weight,
              int threads, MeshMatrix& hessian, Eigen::VectorXd& gradient) {
  constexpr Index kBatch = 16384;
  constexpr Index kGrain = 1024;
  hessian.set_zero();
  gradient.setZero(2 * hessian.free_count());
  std::vector<FaceModel> models(std::min(kBatch, size_of(faces)));
  for (Index first = 0; first < size_of(faces); first += kBatch) {
    const Index count = std::min(kBatch, size_of(faces) - first);
    parallel_for(threads, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        const Triangle& t = faces[first + i];
        const RestTriangle& r = rest[first + i];
        const LinearMap map = linear_map(r, uvs[t[0]], uvs[t[1]], uvs[t[2]]);
        models[i] = face_model(r, map, density);
        const double w = weight(static_cast<Index>(first + i));
        models[i].gradient *= w;
        models[i].hessian *= w;
      }
    });
    for (Index i = 0; i < count; ++i) {
      const Triangle& t = faces[first + i];
      for (int k = 0; k < 3; ++k) {
        const Index row = hessian.row(t[k]);
        if (row != kNone) gradient.segment<2>(2 * row) += models[i].gradient.segment<2>(2 * k);
        for (int l = k; l < 3; ++l) {
          hessian.add(first + i, t, k, l,
                      [&](int r, int c) { return models[i].hessian(2 * k + r, 2 * l + c); });
        }
      }
    }
  }
}

}  // namespace beltrami
