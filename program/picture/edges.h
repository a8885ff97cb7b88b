// Edges of triangles, by whether one triangle has them or more.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "files/surface.h"

namespace beltrami::cli {

/// Two vertices, the lesser first.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Edges {
  std::vector<Edge> inner, boundary;
};

/// Each edge once, in increasing order.
inline Edges find_edges(const TriangleView& mesh) {
  std::vector<Edge> all;
  all.reserve(mesh.faces.size());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const std::uint32_t a = mesh.faces[i], b = mesh.faces[i % 3 == 2 ? i - 2 : i + 1];
    all.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(all.begin(), all.end());
  Edges edges;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next] == all[i]) ++next;
    (next == i + 1 ? edges.boundary : edges.inner).push_back(all[i]);
    i = next;
  }
  return edges;
}

}  // namespace beltrami::cli
