// Surfaces that are no disks: with handles, one-sided, in pieces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "support/meshes.h"

namespace beltrami::meshes {

/// A closed torus of n by n cells, n >= 3.
inline TriangleList torus(Index n) {
  TriangleList mesh = torus_with_hole(n);
  mesh.faces.push_back({n * n - 1, 0, n - 1});
  return mesh;
}

/// A band of n >= 3 cells that is glued to itself with a twist: one-sided, one boundary loop.
inline TriangleList moebius(Index n) {
  TriangleList mesh;
  for (Index i = 0; i < n; ++i) {
    const double along = 2 * std::numbers::pi * i / n;
    for (const double across : {-0.4, 0.4}) {
      const double radius = 1 + across * portable::cos(along / 2);
      mesh.positions.push_back({radius * portable::cos(along), radius * portable::sin(along),
                                across * portable::sin(along / 2)});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i, b = a + 1;
    const Index c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    mesh.faces.insert(mesh.faces.end(), {{a, c, b}, {b, c, d}});
  }
  return mesh;
}

/// The parts side by side as one list.
inline TriangleList together(const std::vector<TriangleList>& parts) {
  TriangleList all;
  for (const TriangleList& part : parts) {
    const Index first = size_of(all.positions);
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    for (const auto& [a, b, c] : part.faces) all.faces.push_back({first + a, first + b, first + c});
  }
  return all;
}

/// Two tori glued along a face: genus 2.
inline TriangleList double_torus(Index n) {
  TriangleList mesh = together({torus_with_hole(n), torus_with_hole(n)});
  const Triangle rim = torus(n).faces.back();
  const Index second = n * n;
  // The second one is turned inside out, so that its hole runs as the first one's.
  for (Index f = 2 * n * n - 1; f < size_of(mesh.faces); ++f) {
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    for (Index& v : mesh.faces[f]) {
      for (const Index r : rim) {
        if (v == second + r) v = r;
      }
    }
  }
  return mesh;
}

/// Every corner a vertex of its own.
inline TriangleList soup(const TriangleList& mesh) {
  TriangleList apart;
  for (const Triangle& face : mesh.faces) {
    const Index first = size_of(apart.positions);
    for (const Index v : face) apart.positions.push_back(mesh.positions[v]);
    apart.faces.push_back({first, first + 1, first + 2});
  }
  return apart;
}

/// The sides of a cube, two triangles each.
inline TriangleList cube() {
  TriangleList mesh;
  for (Index i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  for (const auto& [a, b, c, d] : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
  }
  return mesh;
}

/// The same numbers on every machine.
inline Index random_below(std::mt19937_64& generator, Index bound) {
  return static_cast<Index>(generator() % static_cast<std::uint64_t>(bound));
}

/// `faces` triangles of different corners among `vertices` random points.
inline TriangleList random_soup(Index vertices, Index faces, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  TriangleList mesh;
  for (Index v = 0; v < vertices; ++v) {
    Vec3& p = mesh.positions.emplace_back();
    for (double& x : p) x = random_below(generator, 1 << 20);
  }
  while (size_of(mesh.faces) < faces) {
    const Index a = random_below(generator, vertices), b = random_below(generator, vertices),
                c = random_below(generator, vertices);
    if (a != b && b != c && c != a) mesh.faces.push_back({a, b, c});
  }
  return mesh;
}

/// A random order of [0, count).
inline std::vector<Index> shuffled(Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (Index i = count; i-- > 1;) std::swap(order[i], order[random_below(generator, i + 1)]);
  return order;
}

}  // namespace beltrami::meshes
