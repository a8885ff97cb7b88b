// What an energy density tells the optimisers about itself.
//
// A Density is a type with
//   kBarrier                 whether it is infinite at s2 = 0, so that steps must stop short of it
//   kSmooth                  whether its second derivatives are continuous where it is finite
//   kMinimum                 its value at the isometries
//   kCurvature               its second derivatives at the identity
//   value(s1, s2)            the density, of the signed singular values s1 >= |s2|
//   model(s1, s2)            value, derivatives and a positive semi-definite model of the Hessian
//   Proxy                    a type with another model(s1, s2) of the same density, for the start
//   slopes(map)              value and gradient by fz and fzbar alone
//   bends(norm, det)         second derivatives by s1^2 + s2^2 and s1 s2, or what is like them
//   best_scale(sum)          the global scale at which its sum over a map is least; sum(term) adds
//                            up over the faces the array that term(area, s1, s2) returns for each
// and, where it grows otherwise than quadratically with lengths and their inverses,
//   to_dirichlet(energy)     the symmetric Dirichlet energy of an even map of that value
//   from_dirichlet(energy)   the value of a face of that symmetric Dirichlet energy
#pragma once

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

/// The model of SLIM (Rabinovich et al. 2017): 1/2 |W (J - R)|^2 with squared weights w1, w2 on the
/// singular directions, chosen so that its gradient is the density's. Its minimum is a rotation,
/// not a small move: where a face is nearly singular its curvature is far below Newton's, so that
/// it does not block the others.
inline void use_weighted_rotation_model(double w1, double w2, DensityModel& model) {
  model.h11 = w1;
  model.h12 = 0;
  model.h22 = w2;
  model.twist = model.flip = w1 + w2;
  model.coupling = w2 - w1;
}

/// Value of a density at a linear map, and its gradient: by_fz * fz and by_fzbar * fzbar.
struct DensitySlopes {
  double value;
  double by_fz, by_fzbar;
};

/// Second derivatives of a density as a function of norm = s1^2 + s2^2 and det = s1 s2, of which
/// the one is quadratic in where a corner goes and the other linear.
struct DensityBends {
  double norm_norm, norm_det, det_det;
};

}  // namespace beltrami
