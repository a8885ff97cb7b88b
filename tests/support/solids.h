// Closed surfaces as fine as a test needs, and what is done to their vertices.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "support/meshes.h"
#include "support/surfaces.h"

namespace beltrami::meshes {

/// Every face as four, with new vertices in the middle of the edges.
inline TriangleList split_in_four(const TriangleList& mesh, int times = 1) {
  if (times == 0) return mesh;
  TriangleList fine{mesh.positions, {}};
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [place, is_new] =
        middles.emplace(std::pair(std::min(a, b), std::max(a, b)), size_of(fine.positions));
    if (is_new) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.faces) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return split_in_four(fine, times - 1);
}

template <class Place>
TriangleList moved(TriangleList mesh, const Place& place) {
  for (Vec3& p : mesh.positions) p = place(Vec3(p));
  return mesh;
}

/// The unit sphere in 8 * 4^times faces, symmetric to the planes of the axes.
inline TriangleList sphere(int times) {
  return moved(split_in_four(octahedron(), times),
               [](const Vec3& p) { return Vec3(p / p.norm()); });
}

/// Moves every vertex by up to `size` along each axis.
inline TriangleList shaken(const TriangleList& mesh, double size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  return moved(mesh, [&](Vec3 p) {
    for (double& x : p) x += size * (random_below(generator, 2001) - 1000) / 1000;
    return p;
  });
}

/// A turn about an axis that is no axis of anything.
inline Eigen::Matrix3d some_turn() {
  const Vec3 axis = Vec3(1, 2, 3) / Vec3(1, 2, 3).norm();
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + portable::sin(1) * cross +
         (1 - portable::cos(1)) * cross * cross;
}

}  // namespace beltrami::meshes
