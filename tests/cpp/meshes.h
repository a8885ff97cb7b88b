// Small meshes in the arrays that hosts have.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace beltrami::host {

using Position = std::array<double, 3>;
using Face = std::array<std::uint32_t, 3>;

struct Triangles {
  std::vector<Position> positions;
  std::vector<Face> faces;
};

struct Polygons {
  std::vector<Position> positions;
  std::vector<std::uint32_t> corners, sizes;
};

/// Two triangles that are bent along their common edge: a disk.
inline Triangles bent_quad() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A disk of `n` squares a side with a hump: (n + 1)^2 vertices, 2 n^2 triangles.
inline Triangles hump(std::uint32_t n) {
  Triangles mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t k = 0; k <= n; ++k) {
      const double x = double(i) / n - 0.5, y = double(k) / n - 0.5;
      mesh.positions.push_back({x, y, std::exp(-8 * (x * x + y * y))});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = i * (n + 1) + k, b = a + n + 1;
      mesh.faces.push_back({a, b, b + 1});
      mesh.faces.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// A cube of six squares.
inline Polygons cube() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
          {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7},
          {4, 4, 4, 4, 4, 4}};
}

/// The same of twelve triangles.
inline Triangles triangulated_cube() {
  const Polygons squares = cube();
  Triangles mesh{squares.positions, {}};
  for (std::size_t i = 0; i < squares.corners.size(); i += 4) {
    const std::uint32_t* at = &squares.corners[i];
    mesh.faces.push_back({at[0], at[1], at[2]});
    mesh.faces.push_back({at[0], at[2], at[3]});
  }
  return mesh;
}

}  // namespace beltrami::host
