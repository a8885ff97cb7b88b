// The derivative of a coarse map, carried to the vertices of a finer mesh without frames.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/interpolation.h"

namespace beltrami {

/// At a vertex: the gradients of u and of v as vectors in space, the unit normal of the surface
/// that they are tangent to, and the logarithm of the map's area factor, which averages of
/// gradients that turn lose. A vector, so that averages are plain ones.
class VertexDerivative : public Eigen::Matrix<float, 10, 1> {
 public:
  using Eigen::Matrix<float, 10, 1>::Matrix;

  auto gradient_u() const { return segment<3>(0); }
  auto gradient_v() const { return segment<3>(3); }
  auto normal() const { return segment<3>(6); }
  float scale() const { return (*this)[9]; }
};

/// Those of a map whose faces are all positive: means over the faces of each vertex by area.
std::vector<VertexDerivative> vertex_derivatives(const DiskMesh& mesh,
                                                 const std::vector<RestTriangle>& rest,
                                                 const std::vector<Vec2>& uvs, const Work& work);

/// The same at the footpoints of a finer mesh.
std::vector<VertexDerivative> carried(const std::vector<VertexDerivative>& coarse,
                                      const std::vector<Footpoint>& points, const Work& work);

/// The map of the face `f` of a mesh with these derivatives at its corners, in the frame of its
/// rest triangle: their mean, turned as little as takes its normal to that of the face, with the
/// mean scale. fz = 0 where the face has no shape in space.
inline LinearMap derivative_of_face(const DiskMesh& mesh, Index f, const RestTriangle& rest,
                                    const std::vector<VertexDerivative>& derivatives) {
  constexpr double kMostStretched = 0.98;  // |fzbar|^2 over |fz|^2: means may come near to flipping
  constexpr double kOpposite = 1e-3;       // 1 + cosine below which normals have no turn between
  constexpr double kUnit = 0.1;            // how far from a unit vector what is mollified is
  const Triangle& t = mesh.faces[f];
  const Vec3& origin = mesh.positions[t[0]];
  const Vec3 x = (1 / rest.x1) * (mesh.positions[t[1]] - origin);
  const Vec3 y = (1 / rest.y2) * (mesh.positions[t[2]] - origin - rest.x2 * x);
  if (!(std::abs(x.squaredNorm() - 1) < kUnit && std::abs(y.squaredNorm() - 1) < kUnit)) {
    return {0, 0};
  }
  const VertexDerivative sum = derivatives[t[0]] + derivatives[t[1]] + derivatives[t[2]];
  const Vec3 normal = x.cross(y), upright = sum.normal().cast<double>();
  const double length = upright.norm();
  // Onto the plane of the other normal by the least turn: e - (e.u) (u + n) / (1 + u.n).
  const double inverse = length > 0 ? 1 / length : 0;
  const double cosine = inverse * upright.dot(normal);
  const Vec3 middle = (inverse * upright + normal) * (inverse / std::max(1 + cosine, kOpposite));
  const Vec3 turned_x = x - upright.dot(x) * middle, turned_y = y - upright.dot(y) * middle;
  const Vec3 by_u = sum.gradient_u().cast<double>(), by_v = sum.gradient_v().cast<double>();
  const double ux = by_u.dot(turned_x), vx = by_v.dot(turned_x);
  const double uy = by_u.dot(turned_y), vy = by_v.dot(turned_y);
  LinearMap map{{0.5 * (ux + vy), 0.5 * (vx - uy)}, {0.5 * (ux - vy), 0.5 * (vx + uy)}};
  const double a_sq = std::norm(map.fz);
  double b_sq = std::norm(map.fzbar);
  if (!(a_sq > 0)) return {0, 0};
  if (b_sq > kMostStretched * a_sq) {
    map.fzbar *= std::sqrt(kMostStretched * a_sq / b_sq);
    b_sq = kMostStretched * a_sq;
  }
  const double scale = sum.scale() / (3 * std::sqrt(a_sq - b_sq));
  return {scale * map.fz, scale * map.fzbar};
}

}  // namespace beltrami
