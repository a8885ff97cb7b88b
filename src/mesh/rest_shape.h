// Faces laid flat: the geometry that energies and coefficients are measured against.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// A face in its own plane: corner 0 at the origin, corner 1 at (x1, 0), corner 2 at (x2, y2).
/// x1 > 0, y2 > 0 always, also for faces that have no area in space (see rest_triangles).
struct RestTriangle {
  double x1, x2, y2;

  RestTriangle() {}  // leaves a large array as it is: no thread fills it before it is written
  RestTriangle(double width, double apex_x, double apex_y) : x1(width), x2(apex_x), y2(apex_y) {}

  double area() const { return 0.5 * x1 * y2; }
  Complex corner(int k) const { return k == 0 ? 0.0 : k == 1 ? Complex(x1) : Complex(x2, y2); }
  /// Gradient of the hat function of corner k, as gx + i gy: i * opposite edge / (2 area).
  Complex hat_gradient(int k) const {
    const Complex edge = corner(previous_corner(k)) - corner(next_corner(k));
    return Complex(-edge.imag(), edge.real()) / (x1 * y2);
  }
};

/// A linear map of a face in complex notation: f(z) = fz * z + fzbar * conj(z).
struct LinearMap {
  Complex fz, fzbar;
};

/// The linear map that takes the rest triangle to the corners w. Its singular values are
/// |fz| +- |fzbar|.
inline LinearMap linear_map(const RestTriangle& rest, const Vec2& w0, const Vec2& w1,
                            const Vec2& w2) {
  // f_x = (w1 - w0) / x1; f_y from the apex; fz = (f_x - i f_y) / 2, fzbar = (f_x + i f_y) / 2.
  const double inv_x1 = 1 / rest.x1, inv_y2 = 1 / rest.y2;
  const double ux = (w1.x() - w0.x()) * inv_x1, vx = (w1.y() - w0.y()) * inv_x1;
  const double uy = (w2.x() - w0.x() - rest.x2 * ux) * inv_y2;
  const double vy = (w2.y() - w0.y() - rest.x2 * vx) * inv_y2;
  return {{0.5 * (ux + vy), 0.5 * (vx - uy)}, {0.5 * (ux - vy), 0.5 * (vx + uy)}};
}

/// Whether a face has no shape in space: its height is below 1e-9 of its longest edge (zero area,
/// duplicate positions).
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c);

/// The faces for which is_degenerate holds, in order.
std::vector<Index> degenerate_faces(const std::vector<Vec3>& positions,
                                    const std::vector<Triangle>& faces, const Work& work);

/// Lays every face flat. A degenerate face is valid topology without geometry: it is given a height
/// of 1e-3 of its longest edge, or of the mean edge where it has no extent at all, so that every
/// energy stays finite.
std::vector<RestTriangle> rest_triangles(const std::vector<Vec3>& positions,
                                         const std::vector<Triangle>& faces, const Work& work);

}  // namespace beltrami
