// The plain types that every stage shares. Points are in base/vectors.h: Eigen is not for all.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

namespace beltrami {

/// Vertex, face and half-edge index. 32 bits hold meshes of up to 700 million faces.
using Index = std::int32_t;
inline constexpr Index kNone = -1;

using Complex = std::complex<double>;

/// |z| without the care that std::abs takes of numbers near the ends of the range, at a fifth of
/// its cost.
inline double modulus(Complex z) {
  return std::sqrt(z.real() * z.real() + z.imag() * z.imag());
}

/// a / b without the care that compilers take, or do not, of numbers near the ends of the range:
/// the same bits from each of them.
inline Complex quotient(Complex a, Complex b) {
  return a * std::conj(b) / std::norm(b);
}

/// Corner vertices of a face, counter-clockwise.
using Triangle = std::array<Index, 3>;

/// The corner after / before corner `k` of a triangle.
constexpr int next_corner(int k) {
  return k == 2 ? 0 : k + 1;
}
constexpr int previous_corner(int k) {
  return k == 0 ? 2 : k - 1;
}

template <class T>
Index size_of(const std::vector<T>& items) {
  return static_cast<Index>(items.size());
}

}  // namespace beltrami
