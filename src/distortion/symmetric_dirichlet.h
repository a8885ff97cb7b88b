// The symmetric Dirichlet energy (Smith & Schaefer 2015): 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2).
#pragma once

#include <algorithm>

namespace beltrami {

/// Value, derivatives and a positive semi-definite model of the Hessian of an energy density in the
/// signed singular values s1 >= |s2|. With fz = a e^{i alpha}, fzbar = b e^{i beta}: s1 = a + b,
/// s2 = a - b. The Hessian in (fz, fzbar) is block diagonal: a radial 2x2 block, and one eigenvalue
/// for each of the two angular directions, "twist" (d/da / a) and "flip" (d/db / b).
struct DensityModel {
  double value;
  double d1, d2;         ///< derivatives by s1 and s2
  double h11, h12, h22;  ///< radial block, positive semi-definite
  double twist, flip;    ///< >= 0
  double coupling = 0;   ///< between twist and flip, at most sqrt(twist * flip)
};

/// The energy density that the full-space optimisation minimises. Defined for s2 > 0.
struct SymmetricDirichlet {
  static constexpr bool kBarrier = true;  // infinite at s2 = 0

  static double value(double s1, double s2) {
    return 0.5 * (s1 * s1 + s2 * s2 + 1 / (s1 * s1) + 1 / (s2 * s2));
  }

  /// The exact Hessian but for the twist eigenvalue, the only one that can be negative: clamped.
  static DensityModel model(double s1, double s2) {
    const double i1 = 1 / (s1 * s1), i2 = 1 / (s2 * s2), det = s1 * s2;
    DensityModel m;
    m.value = 0.5 * (s1 * s1 + s2 * s2 + i1 + i2);
    m.d1 = s1 - i1 / s1;
    m.d2 = s2 - i2 / s2;
    m.h11 = 1 + 3 * i1 * i1;
    m.h12 = 0;
    m.h22 = 1 + 3 * i2 * i2;
    m.twist = std::max(0.0, 2 * (m.d1 + m.d2) / (s1 + s2));
    m.flip = 2 * (1 + (s1 * s1 + det + s2 * s2) / (det * det * det));
    return m;
  }
};

/// The same energy with the quadratic model of SLIM (Rabinovich et al. 2017): 1/2 |W (J - R)|^2 with
/// weights w_i^2 = Psi'(s_i) / (s_i - 1). Its minimum is a rotation, not a small move: where a face
/// is nearly singular its curvature is far below Newton's, so that it does not block the others.
struct SymmetricDirichletProxy {
  static DensityModel model(double s1, double s2) {
    const auto weight = [](double s) { return (s + 1) * (s * s + 1) / (s * s * s); };
    DensityModel m = SymmetricDirichlet::model(s1, s2);
    m.h11 = weight(s1);
    m.h12 = 0;
    m.h22 = weight(s2);
    m.twist = m.flip = m.h11 + m.h22;
    m.coupling = m.h22 - m.h11;
    return m;
  }
};

}  // namespace beltrami
