// Small meshes for tests: disks of several kinds, and one mesh for each way not to be a disk.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami::meshes {

/// Plain arrays; Vec3 is three packed doubles and Triangle three packed 32-bit indices.
struct TriangleList {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
};

inline TriangleList triangle() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
}

inline TriangleList quad() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// `n` faces around vertex 0, whose boundary is a regular polygon of n >= 3 corners.
inline TriangleList fan(Index n) {
  TriangleList mesh{{{0, 0, 0}}, {}};
  for (Index i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({portable::cos(angle), portable::sin(angle), 0});
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % n});
  }
  return mesh;
}

/// A height field over [0, 1]^2 of nx by ny cells, two faces each.
inline TriangleList height_field(Index nx, Index ny,
                                 const std::function<double(double x, double y)>& height) {
  TriangleList mesh;
  for (Index j = 0; j <= ny; ++j) {
    for (Index i = 0; i <= nx; ++i) {
      const double x = static_cast<double>(i) / nx, y = static_cast<double>(j) / ny;
      mesh.positions.push_back({x, y, height(x, y)});
    }
  }
  for (Index j = 0; j < ny; ++j) {
    for (Index i = 0; i < nx; ++i) {
      const Index a = j * (nx + 1) + i, b = a + 1, c = b + nx + 1, d = a + nx + 1;
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  return mesh;
}

inline TriangleList grid(Index nx, Index ny) {
  return height_field(nx, ny, [](double, double) { return 0.0; });
}

/// Curved both ways and not developable.
inline TriangleList bumps(Index nx, Index ny) {
  return height_field(nx, ny, [](double x, double y) {
    return 0.3 * portable::sin(7 * x) * portable::cos(5 * y + x);
  });
}

/// A strip of n cells: every vertex lies on the boundary.
inline TriangleList strip(Index n) {
  return grid(n, 1);
}

/// The part of the unit sphere within `angle` of the pole: nested rings around vertex 0.
inline TriangleList cap(Index rings, Index sectors, double angle) {
  TriangleList mesh = fan(sectors);
  mesh.positions.assign(1, {0, 0, 1});
  for (Index r = 1; r <= rings; ++r) {
    const double polar = angle * r / rings;
    for (Index s = 0; s < sectors; ++s) {
      const double azimuth = 2 * std::numbers::pi * s / sectors;
      mesh.positions.push_back({portable::sin(polar) * portable::cos(azimuth),
                                portable::sin(polar) * portable::sin(azimuth),
                                portable::cos(polar)});
    }
  }
  for (Index r = 1; r < rings; ++r) {
    for (Index s = 0; s < sectors; ++s) {
      const Index t = (s + 1) % sectors;
      const Index a = 1 + (r - 1) * sectors + s, b = 1 + (r - 1) * sectors + t;
      const Index c = a + sectors, d = b + sectors;
      mesh.faces.push_back({a, c, d});
      mesh.faces.push_back({a, d, b});
    }
  }
  return mesh;
}

// ---- Not disks ------------------------------------------------------------------------------

inline TriangleList tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

inline TriangleList octahedron() {
  return {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
}

/// Two boundary loops: an outer one of vertices 0 to n - 1, an inner one of n to 2n - 1.
inline TriangleList annulus(Index n) {
  TriangleList mesh;
  for (const double radius : {2.0, 1.0}) {
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.positions.push_back({radius * portable::cos(angle), radius * portable::sin(angle), 0});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.faces.push_back({i, j, n + i});
    mesh.faces.push_back({j, n + j, n + i});
  }
  return mesh;
}

/// A torus of n by n cells (n >= 3) without its last face: genus 1, one boundary loop.
inline TriangleList torus_with_hole(Index n) {
  TriangleList mesh;
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / n;
      mesh.positions.push_back({(2 + portable::cos(v)) * portable::cos(u),
                                (2 + portable::cos(v)) * portable::sin(u), portable::sin(v)});
      const Index a = j * n + i, b = j * n + (i + 1) % n;
      const Index c = (j + 1) % n * n + (i + 1) % n, d = (j + 1) % n * n + i;
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  mesh.faces.pop_back();
  return mesh;
}

/// Faces 0 and 1 are apart.
inline TriangleList two_components() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}},
          {{0, 1, 2}, {3, 4, 5}}};
}

/// Three faces on the edge 0-1.
inline TriangleList three_on_an_edge() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
          {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
}

/// Two faces that share vertex 0 only.
inline TriangleList bowtie() {
  return {{{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {-1, 1, 0}}, {{0, 2, 1}, {0, 4, 3}}};
}

/// Face 1 runs against face 0.
inline TriangleList against_each_other() {
  TriangleList mesh = quad();
  std::swap(mesh.faces[1][1], mesh.faces[1][2]);
  return mesh;
}

/// Shifts all vertex numbers by `count` vertices, which no face uses, in front.
inline TriangleList with_unused_in_front(TriangleList mesh, Index count) {
  mesh.positions.insert(mesh.positions.begin(), static_cast<std::size_t>(count), Vec3(9, 9, 9));
  for (Triangle& face : mesh.faces) {
    for (Index& v : face) v += count;
  }
  return mesh;
}

}  // namespace beltrami::meshes
