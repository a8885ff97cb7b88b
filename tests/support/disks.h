// Disks that stress the stages, and the little that most stage tests need around them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "support/meshes.h"

namespace beltrami::disks {

inline DiskMesh disk(meshes::TriangleList mesh) {
  return build_disk(std::move(mesh.positions), std::move(mesh.faces), Work(1));
}

inline std::vector<RestTriangle> rest_of(const DiskMesh& mesh) {
  return rest_triangles(mesh.positions, mesh.faces, Work(1));
}

/// The x and y of every vertex: the isometric map of a flat mesh.
inline std::vector<Vec2> flat_uvs(const DiskMesh& mesh) {
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) uvs.push_back({p.x(), p.y()});
  return uvs;
}

/// z + k conj(z) of every vertex.
inline std::vector<Vec2> affine_uvs(const DiskMesh& mesh, Complex k) {
  std::vector<Vec2> uvs;
  for (const Vec3& p : mesh.positions) {
    const Complex z(p.x(), p.y());
    const Complex w = z + k * std::conj(z);
    uvs.push_back({w.real(), w.imag()});
  }
  return uvs;
}

inline std::vector<bool> only_fixed(const DiskMesh& mesh, Index vertex) {
  std::vector<bool> fixed(mesh.positions.size(), false);
  fixed[static_cast<std::size_t>(vertex)] = true;
  return fixed;
}

/// The same numbers on every system, which the distributions of the standard library are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int bound) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(bound)); }
  Vec2 vec2() { return {between(-1, 1), between(-1, 1)}; }
  Vec3 vec3() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }

 private:
  std::mt19937_64 engine_;
};

/// The cells of an nx by ny grid of unit squares that `keeps(i, j)` keeps.
template <class Keeps>
meshes::TriangleList cells(Index nx, Index ny, const Keeps& keeps) {
  const meshes::TriangleList all = meshes::grid(nx, ny);
  meshes::TriangleList kept;
  for (Index f = 0; f < size_of(all.faces); ++f) {
    if (keeps(f / 2 % nx, f / 2 / nx)) kept.faces.push_back(all.faces[f]);
  }
  for (const Index v : drop_unreferenced(size_of(all.positions), kept.faces, Work(1))) {
    const Vec3& p = all.positions[v];
    kept.positions.push_back({p.x() * nx, p.y() * ny, 0});
  }
  return kept;
}

/// Two squares of n by n cells joined by a corridor that is one cell wide and n long, bent upwards.
inline meshes::TriangleList dumbbell(Index n) {
  auto mesh = cells(3 * n, n, [n](Index i, Index j) { return i < n || i >= 2 * n || j == n / 2; });
  for (Vec3& p : mesh.positions) p.z() = 0.05 * p.x() * p.x() / n;
  return mesh;
}

/// A tube of radius 1, closed at one end: nested rings around vertex 0, each `height` lower.
/// Tutte's embedding squeezes it exponentially with its length.
inline meshes::TriangleList tube(Index rings, Index sectors, double height) {
  meshes::TriangleList mesh = meshes::cap(rings, sectors, 1);
  for (Index v = 1; v < size_of(mesh.positions); ++v) {
    const Index ring = (v - 1) / sectors, sector = (v - 1) % sectors;
    const double azimuth = 2 * std::numbers::pi * sector / sectors;
    const double depth = height * (1 + ring);
    mesh.positions[v] = {portable::cos(azimuth), portable::sin(azimuth), -depth};
  }
  return mesh;
}

/// A ramp that winds up one and a half turns: flattened without distortion it covers itself.
inline meshes::TriangleList ramp(Index along, Index across) {
  meshes::TriangleList mesh = meshes::grid(along, across);
  for (Vec3& p : mesh.positions) {
    const double angle = -3 * std::numbers::pi * p.x(), radius = 1 + p.y();
    p = {radius * portable::sin(angle), -radius * portable::cos(angle), 0.1 * angle};
  }
  return mesh;
}

/// A flat grid whose middle vertex stands out by twenty times its width.
inline meshes::TriangleList spike(Index n) {
  meshes::TriangleList mesh = meshes::grid(n, n);
  mesh.positions[(n / 2) * (n + 1) + n / 2].z() = 20;
  return mesh;
}

/// A curved grid of triangles 200 times longer than high.
inline meshes::TriangleList slivers(Index nx, Index ny) {
  meshes::TriangleList mesh = meshes::grid(nx, ny);
  for (Vec3& p : mesh.positions) {
    p = {200 * p.x() * nx, p.y() * ny, 10 * portable::sin(3 * p.x() + 2 * p.y())};
  }
  return mesh;
}

/// A bumpy grid in which some neighbours coincide and some faces are collinear.
inline meshes::TriangleList degenerate_faces(Index n) {
  meshes::TriangleList mesh = meshes::bumps(n, n);
  const auto at = [n](Index i, Index j) { return j * (n + 1) + i; };
  mesh.positions[at(2, 2)] = mesh.positions[at(3, 2)];
  mesh.positions[at(n - 2, 2)] =
      0.5 * (mesh.positions[at(n - 3, 1)] + mesh.positions[at(n - 1, 3)]);
  mesh.positions[at(n - 3, 1)] = mesh.positions[at(n - 2, 2)] + Vec3(0.1, 0, 0);
  mesh.positions[at(n - 1, 2)] = mesh.positions[at(n - 2, 2)] + Vec3(0.2, 0, 0);
  return mesh;
}

/// A flat grid of 2n by 2n cells slit from the middle of its right side to its centre: the two
/// sides of the slit coincide.
inline meshes::TriangleList slit(Index n) {
  meshes::TriangleList mesh = meshes::grid(2 * n, 2 * n);
  const Index row = n * (2 * n + 1);
  for (Index i = n + 1; i <= 2 * n; ++i) {
    const Index lower = row + i, upper = size_of(mesh.positions);
    mesh.positions.push_back(Vec3(mesh.positions[lower]));
    for (std::size_t f = static_cast<std::size_t>(4) * n * n; f < mesh.faces.size(); ++f) {
      for (Index& v : mesh.faces[f]) {
        if (v == lower) v = upper;
      }
    }
  }
  return mesh;
}

/// A closed sphere-like surface, an octahedron split `levels` times, without its first face: a
/// boundary of three vertices.
inline meshes::TriangleList punctured(int levels) {
  meshes::TriangleList mesh = meshes::octahedron();
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> faces;
    std::vector<std::pair<std::pair<Index, Index>, Index>> middles;
    const auto middle = [&](Index a, Index b) {
      const std::pair<Index, Index> edge = std::minmax(a, b);
      for (const auto& [known, vertex] : middles) {
        if (known == edge) return vertex;
      }
      mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]).normalized());
      middles.push_back({edge, size_of(mesh.positions) - 1});
      return middles.back().second;
    };
    for (const auto& [a, b, c] : mesh.faces) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.faces = faces;
  }
  mesh.faces.erase(mesh.faces.begin());
  return mesh;
}

}  // namespace beltrami::disks
