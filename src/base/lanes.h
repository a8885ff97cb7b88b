// Numbers side by side: what passes over faces are written in where their arithmetic counts.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace beltrami {

/// Faces that are dealt with at once. Fixed, so that sums have the same order on every processor.
inline constexpr int kLanes = 8;

/// Sums, products and quotients of lanes are vector instructions where the processor has them, of
/// the width that the library is built for; no result depends on it.
using Lanes = Eigen::Array<float, kLanes, 1>;

/// As std::sqrt: Eigen's own may be an approximation.
inline Lanes root(const Lanes& x) {
  Lanes result;
  for (int i = 0; i < kLanes; ++i) result[i] = std::sqrt(x[i]);
  return result;
}

struct LanesComplex {
  Lanes real, imag;
};

inline LanesComplex operator*(const LanesComplex& a, const LanesComplex& b) {
  return {a.real * b.real - a.imag * b.imag, a.real * b.imag + a.imag * b.real};
}
inline LanesComplex operator+(const LanesComplex& a, const LanesComplex& b) {
  return {a.real + b.real, a.imag + b.imag};
}
inline LanesComplex operator-(const LanesComplex& a, const LanesComplex& b) {
  return {a.real - b.real, a.imag - b.imag};
}
inline LanesComplex operator*(const Lanes& a, const LanesComplex& b) {
  return {a * b.real, a * b.imag};
}
inline LanesComplex conj(const LanesComplex& z) {
  return {z.real, -z.imag};
}
inline Lanes squared_modulus(const LanesComplex& z) {
  return z.real * z.real + z.imag * z.imag;
}

/// Vectors in space.
struct LanesVec3 {
  Lanes x, y, z;

  Lanes dot(const LanesVec3& b) const { return x * b.x + y * b.y + z * b.z; }
  LanesVec3 cross(const LanesVec3& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
};

inline LanesVec3 operator+(const LanesVec3& a, const LanesVec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LanesVec3 operator-(const LanesVec3& a, const LanesVec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LanesVec3 operator*(const Lanes& a, const LanesVec3& b) {
  return {a * b.x, a * b.y, a * b.z};
}

}  // namespace beltrami
