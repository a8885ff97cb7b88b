// The exponential symmetric Dirichlet energy: 1 + exp(D - 2) of the symmetric Dirichlet energy D,
// as Rabinovich et al. 2017, "Scalable Locally Injective Mappings", have it (after the exponential
// of Fu et al. 2015, "Computing Locally Injective Mappings by Advanced MIPS"), so that what is
// distorted most counts most. From D = 14 on the exponential goes on as the parabola that has its
// value and first two derivatives there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/bracket.h"
#include "base/portable_math.h"
#include "energy/density.h"
#include "energy/symmetric_dirichlet.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Defined for s2 > 0; minimum 2 at the isometries, where it differs from symmetric Dirichlet in
/// the fourth order alone.
struct ExponentialDirichlet {
  static constexpr bool kBarrier = true;
  static constexpr bool kSmooth = true;
  static constexpr double kMinimum = SymmetricDirichlet::kMinimum;
  static constexpr double kCurvature = SymmetricDirichlet::kCurvature;

  static double value(double s1, double s2) {
    return growth(SymmetricDirichlet::value(s1, s2)).value;
  }

  /// The exact Hessian but for the twist, as far as that of symmetric Dirichlet is: what growth
  /// adds to it, its curvature times the square of the gradient, is positive semi-definite.
  static DensityModel model(double s1, double s2) {
    const DensityModel d = SymmetricDirichlet::model(s1, s2);
    const Growth g = growth(d.value);
    DensityModel m;
    m.value = g.value;
    m.d1 = g.slope * d.d1;
    m.d2 = g.slope * d.d2;
    m.h11 = g.slope * d.h11 + g.curvature * d.d1 * d.d1;
    m.h12 = g.curvature * d.d1 * d.d2;
    m.h22 = g.slope * d.h22 + g.curvature * d.d2 * d.d2;
    m.twist = g.slope * d.twist;
    m.flip = g.slope * d.flip;
    return m;
  }

  /// Weights of symmetric Dirichlet, grown like its gradient.
  struct Proxy {
    static DensityModel model(double s1, double s2) {
      const DensityModel d = SymmetricDirichlet::Proxy::model(s1, s2);
      const double slope = growth(d.value).slope;
      DensityModel m = ExponentialDirichlet::model(s1, s2);
      use_weighted_rotation_model(slope * d.h11, slope * d.h22, m);
      return m;
    }
  };

  static DensitySlopes slopes(const LinearMap& map) {
    const DensitySlopes d = SymmetricDirichlet::slopes(map);
    const Growth g = growth(d.value);
    return {g.value, g.slope * d.by_fz, g.slope * d.by_fzbar};
  }

  /// By the chain rule, like those of the model.
  static DensityBends bends(double norm, double det) {
    const double inverse = 1 / det, inverse_sq = inverse * inverse;
    const double by_norm = 0.5 * (1 + inverse_sq), by_det = -norm * inverse_sq * inverse;
    const Growth g = growth(norm * by_norm);
    const DensityBends d = SymmetricDirichlet::bends(norm, det);
    return {g.slope * d.norm_norm + g.curvature * by_norm * by_norm,
            g.slope * d.norm_det + g.curvature * by_norm * by_det,
            g.slope * d.det_det + g.curvature * by_det * by_det};
  }

  /// The sum is convex in the logarithm of the scale: Newton's method from the best one of
  /// symmetric Dirichlet, between bounds that close in.
  template <class Sum>
  static double best_scale(const Sum& sum) {
    const double start = SymmetricDirichlet::best_scale(sum);
    Bracket log_scale{-kFarthest, kFarthest};
    double at = 0;
    for (double step = 1; std::abs(step) > kSameScale;) {
      const double scale = portable::exp(at) * start;
      const auto [slope, curvature] = sum([&](double area, double s1, double s2) {
        const double square1 = scale * s1 * scale * s1, square2 = scale * s2 * scale * s2;
        const double rising = square1 + square2, falling = 1 / square1 + 1 / square2;
        const Growth g = growth(0.5 * (rising + falling));
        const double change = rising - falling;
        return std::array{area * g.slope * change, area * (g.curvature * change * change +
                                                           2 * g.slope * (rising + falling))};
      });
      if (!std::isfinite(curvature)) return start;
      log_scale.note(at, slope > 0);
      const double next = log_scale.inside(at - slope / curvature);
      step = next - at;
      at = next;
    }
    return portable::exp(at) * start;
  }

  static double to_dirichlet(double energy) {
    const double grown = energy - 1;
    if (!(grown >= kLastGrown)) return 2 + portable::log(grown);
    return kLast + (std::sqrt(2 * grown / kLastGrown - 1) - 1);
  }
  static double from_dirichlet(double energy) { return growth(energy).value; }

 private:
  /// The energy as a function of symmetric Dirichlet, with its derivatives: rising and convex.
  struct Growth {
    double value, slope, curvature;
  };
  static Growth growth(double dirichlet) {
    const double beyond = std::max(0.0, dirichlet - kLast);
    const double grown = portable::exp(std::min(dirichlet, kLast) - 2);
    return {1 + grown * (1 + beyond * (1 + 0.5 * beyond)), grown * (1 + beyond), grown};
  }

  /// Where the exponential ends. Minima of ordinary surfaces are all below it. Beyond, it would
  /// overflow at the starts of descents, and a few faces of surfaces that no map keeps below it
  /// would be all that is seen of them.
  static constexpr double kLast = 14;
  static constexpr double kLastGrown = 162754.79141900392;  // exp(kLast - 2)
  // Logarithms of scales, from that of symmetric Dirichlet: what is looked through, and what does
  // not differ in the energy.
  static constexpr double kFarthest = 10, kSameScale = 1e-9;
};

}  // namespace beltrami
