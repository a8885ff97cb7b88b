// The symmetric Dirichlet energy (Smith & Schaefer 2015): 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "energy/density.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Defined for s2 > 0; minimum 2 at the isometries.
struct SymmetricDirichlet {
  static constexpr bool kBarrier = true;
  static constexpr bool kSmooth = true;
  static constexpr double kMinimum = 2;
  static constexpr double kCurvature = 4;

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

  /// w_i = Psi'(s_i) / (s_i - 1).
  struct Proxy {
    static DensityModel model(double s1, double s2) {
      const auto weight = [](double s) { return (s + 1) * (s * s + 1) / (s * s * s); };
      DensityModel m = SymmetricDirichlet::model(s1, s2);
      use_weighted_rotation_model(weight(s1), weight(s2), m);
      return m;
    }
  };

  /// (|fz|^2 + |fzbar|^2) (1 + det^-2) with det = |fz|^2 - |fzbar|^2: no square root.
  static DensitySlopes slopes(const LinearMap& map) {
    const double x = std::norm(map.fz), y = std::norm(map.fzbar), det = x - y;
    const double inverse_sq = 1 / (det * det);
    const double by_norm = 2 * (1 + inverse_sq), by_det = -4 * (x + y) * inverse_sq / det;
    return {0.5 * (x + y) * by_norm, by_norm + by_det, by_norm - by_det};
  }

  /// Of norm (1 + det^-2) / 2.
  static DensityBends bends(double norm, double det) {
    const double inverse = 1 / det, inverse_cube = inverse * inverse * inverse;
    return {0, -inverse_cube, 3 * norm * inverse_cube * inverse};
  }

  /// s^4 = sum(A / sigma^2) / sum(A sigma^2) over both singular values.
  template <class Sum>
  static double best_scale(const Sum& sum) {
    const auto [norm_sq, inverse_norm_sq] = sum([](double area, double s1, double s2) {
      return std::array{area * (s1 * s1 + s2 * s2), area / (s1 * s1) + area / (s2 * s2)};
    });
    return std::sqrt(std::sqrt(inverse_norm_sq / norm_sq));
  }
};

}  // namespace beltrami
