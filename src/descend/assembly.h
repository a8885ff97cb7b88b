// Energy, gradient and projected Hessian of a density over a set of faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "energy/density.h"
#include "linear/mesh_matrix.h"
#include "mesh/face_chunks.h"
#include "mesh/rest_shape.h"

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

/// Adds up what `model(face)`, a FaceModel, says of all faces, in parallel.
template <class Model>
void assemble(const std::vector<Triangle>& faces, const Model& model_of, MeshMatrix& hessian,
              Eigen::VectorXd& gradient, const Work& work) {
  struct Aside {
    Index row;
    Vec2 term;
  };
  hessian.set_zero(work);
  gradient.setZero(2 * hessian.free_count());
  const FaceChunks& chunks = hessian.chunks();
  PutAside<Aside> aside(chunks, size_of(hessian.rows()));
  hessian.add_up(work, faces, [&](Index f, const auto& add) {
    const Triangle& t = faces[f];
    const FaceModel model = model_of(f);
    for (int k = 0; k < 3; ++k) {
      const Index row = hessian.row(t[k]);
      if (row == kNone) continue;
      const Vec2 term = model.gradient.template segment<2>(2 * k);
      if (chunks.shared(t[k])) {
        aside.put(chunks.of(f), t[k], {row, term});
      } else {
        gradient.segment<2>(2 * row) += term;
      }
    }
    for (int k = 0; k < 3; ++k) {
      for (int l = k; l < 3; ++l) {
        add(k, l, [&](int r, int c) { return model.hessian(2 * k + r, 2 * l + c); });
      }
    }
  });
  aside.add_up(work, [&](const Aside& a) { gradient.segment<2>(2 * a.row) += a.term; });
}

}  // namespace beltrami
