// Tangent frames on a surface and the parallel transport between them.
#pragma once

#include <Eigen/Geometry>

#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {

/// An orthonormal tangent frame: x and y = n cross x span the tangent plane of the unit normal n. A
/// tangent vector is the complex number of its x and y coordinates.
struct Frame {
  Vec3 x = Vec3::UnitX();
  Vec3 n = Vec3::UnitZ();
};

/// Frame of a face whose x axis is its edge from corner 0 to corner 1, as in RestTriangle. `valid`
/// is set to false (and the frame is arbitrary) if the face has no normal.
inline Frame face_frame(const Vec3& p0, const Vec3& p1, const Vec3& p2, bool& valid) {
  const Vec3 edge = p1 - p0;
  const Vec3 normal = edge.cross(p2 - p0);
  const double edge_length = edge.norm(), normal_length = normal.norm();
  valid = edge_length > 0 && normal_length > 0;
  return valid ? Frame{edge / edge_length, normal / normal_length} : Frame{};
}

/// Frame with a given unit normal and an arbitrary, but reproducible, x axis.
inline Frame frame_of_normal(const Vec3& n) {
  Eigen::Index least;
  n.cwiseAbs().minCoeff(&least);
  return {n.cross(Vec3::Unit(least)).normalized(), n};
}

/// Unit complex r such that the tangent vector z of `from`, rotated by the smallest rotation that
/// takes one normal to the other, is r * z in `to` (the hinge rotation of paper section 3.3).
/// Beltrami coefficients pick up r^2. Opposite normals turn about the x axis of `from`.
inline Complex transport(const Frame& from, const Frame& to) {
  const double cosine = from.n.dot(to.n);
  Vec3 x = from.x;
  if (cosine > -1 + 1e-12) x -= (from.x.dot(to.n) / (1 + cosine)) * (from.n + to.n);
  const Complex r(x.dot(to.x), x.dot(to.n.cross(to.x)));
  const double length = modulus(r);
  return length > 0 ? r / length : Complex(1);
}

}  // namespace beltrami
