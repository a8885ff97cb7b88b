// The symmetric ARAP energy: (s1 - 1)^2 + (1/s2 - 1)^2.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/bracket.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "energy/density.h"
#include "energy/symmetric_dirichlet.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Defined for s2 > 0; minimum 0 at the isometries. It is not symmetric in s1 and s2, hence has a
/// ridge at s1 = s2: its derivative by |fzbar| does not vanish there.
struct SymmetricArap {
  static constexpr bool kBarrier = true;
  static constexpr bool kSmooth = false;
  static constexpr double kMinimum = 0;
  static constexpr double kCurvature = 2;

  static double value(double s1, double s2) {
    const double stretch = s1 - 1, shrink = 1 / s2 - 1;
    return stretch * stretch + shrink * shrink;
  }

  static DensityModel model(double s1, double s2) {
    const double i2 = 1 / s2;
    DensityModel m;
    m.value = value(s1, s2);
    m.d1 = 2 * (s1 - 1);
    m.d2 = -2 * (i2 - 1) * i2 * i2;
    m.h11 = 2;
    m.h12 = 0;
    // Concave for s2 > 1.5, where the proxy's weight takes over; it is the smaller one below 1.
    m.h22 = std::max(i2 * i2 * i2 * (6 * i2 - 4), 0.1 * i2 * i2 * i2);
    m.twist = std::max(0.0, 2 * (m.d1 + m.d2) / (s1 + s2));
    const double a = 0.5 * (s1 + s2), b = std::max(0.5 * (s1 - s2), kRidge * a);
    const double across = m.d1 - m.d2;
    m.flip = std::max(0.0, across / b);
    if (s1 - s2 < 2 * b) smooth_ridge(0.5 * (s1 - s2) / b, m);
    return m;
  }

  struct Proxy {
    static DensityModel model(double s1, double s2) {
      DensityModel m = SymmetricArap::model(s1, s2);
      use_weighted_rotation_model(2, 2 / (s2 * s2 * s2), m);
      return m;
    }
  };

  static DensitySlopes slopes(const LinearMap& map) {
    const double a = modulus(map.fz), b = modulus(map.fzbar);
    const double s1 = a + b, s2 = (a - b) * (a + b) / s1;
    const double d1 = 2 * (s1 - 1), d2 = -2 * (1 / s2 - 1) / (s2 * s2);
    // Smoothed beside the ridge, like the model.
    return {value(s1, s2), (d1 + d2) / a, (d1 - d2) / std::max(b, kRidge * a)};
  }

  /// Twice those of symmetric Dirichlet, like which it grows where s1 is large and where s2 is
  /// small: its own are infinite on the ridge.
  static DensityBends bends(double norm, double det) {
    const DensityBends b = SymmetricDirichlet::bends(norm, det);
    return {2 * b.norm_norm, 2 * b.norm_det, 2 * b.det_det};
  }

  /// The root of a s^4 - b s^3 + d s - c = 0, by bisection of the derivative's sign in log s.
  template <class Sum>
  static double best_scale(const Sum& sum) {
    const auto [sum_s1, s1_sq, inverse_s2, inverse_s2_sq] =
        sum([](double area, double s1, double s2) {
          return std::array{area * s1, area * s1 * s1, area / s2, area / (s2 * s2)};
        });
    Bracket log_scale{-kFarthest, kFarthest};
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = log_scale.middle(), s = portable::exp(middle);
      const double slope = s * s1_sq - sum_s1 - inverse_s2_sq / (s * s * s) + inverse_s2 / (s * s);
      log_scale.note(middle, slope > 0);
    }
    return portable::exp(log_scale.middle());
  }

 private:
  /// Of the logarithm of a scale: beyond it doubles end. So often the bracket is halved.
  static constexpr double kFarthest = 60;
  static constexpr int kHalvings = 100;

  /// Beside the ridge the slope across it falls to 0, a subgradient on it: else every step would
  /// leap over.
  static void smooth_ridge(double share, DensityModel& m) {
    const double along = 0.5 * (m.d1 + m.d2), across = 0.5 * share * (m.d1 - m.d2);
    m.d1 = along + across;
    m.d2 = along - across;
  }

  static constexpr double kRidge = 0.01;  // half-width of the ridge, relative to |fz|
};

}  // namespace beltrami
