// Surfaces opened along seams, and disks that cover themselves where they are laid out freely.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami::disks {

/// Edges that a surface is opened along, each from its lesser vertex.
using Seams = std::set<std::pair<Index, Index>>;

/// The mesh with the sides of its seams apart. Corners at a vertex stay together where no seam is
/// between them.
inline meshes::TriangleList opened(const meshes::TriangleList& mesh, const Seams& seams) {
  const Index corners = 3 * size_of(mesh.faces);
  std::vector<Index> group(static_cast<std::size_t>(corners));
  for (Index c = 0; c < corners; ++c) group[c] = c;
  const auto find = [&](Index c) {
    while (group[c] != c) c = group[c] = group[group[c]];
    return c;
  };
  std::map<std::pair<Index, Index>, std::pair<Index, Index>> halfedges;  // their two corners
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index from = mesh.faces[f][k], to = mesh.faces[f][next_corner(k)];
      halfedges[{from, to}] = {3 * f + k, 3 * f + next_corner(k)};
    }
  }
  for (const auto& [edge, ends] : halfedges) {
    const auto twin = halfedges.find({edge.second, edge.first});
    if (twin == halfedges.end() || seams.contains(std::minmax(edge.first, edge.second))) continue;
    group[find(ends.first)] = find(twin->second.second);
    group[find(ends.second)] = find(twin->second.first);
  }
  meshes::TriangleList result;
  std::vector<Index> vertex(static_cast<std::size_t>(corners), kNone);
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    Triangle face;
    for (int k = 0; k < 3; ++k) {
      Index& v = vertex[find(3 * f + k)];
      if (v == kNone) {
        v = size_of(result.positions);
        result.positions.push_back(mesh.positions[mesh.faces[f][k]]);
      }
      face[k] = v;
    }
    result.faces.push_back(face);
  }
  return result;
}

/// Every face in four, `levels` times; the surface stays as it is.
inline meshes::TriangleList refined(meshes::TriangleList mesh, int levels) {
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [known, fresh] = middles.try_emplace(std::minmax(a, b), size_of(mesh.positions));
      if (fresh) mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
      return known->second;
    };
    std::vector<Triangle> faces;
    for (const auto& [a, b, c] : mesh.faces) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.faces.swap(faces);
  }
  return mesh;
}

/// A closed surface with hills and saddles between them.
inline meshes::TriangleList blob(int levels) {
  meshes::TriangleList mesh = refined(meshes::octahedron(), levels);
  for (Vec3& p : mesh.positions) {
    p.normalize();
    p *= 1 + 0.3 * std::sin(4 * p.x() + 1) * std::cos(3 * p.y()) * std::sin(3 * p.z() + 0.5);
  }
  return mesh;
}

/// Distances along edges from the nearest of `sources`; `before`: the next vertex on the way there.
inline std::vector<double> edge_distances(const meshes::TriangleList& mesh,
                                          const std::vector<Index>& sources,
                                          std::vector<Index>& before) {
  std::vector<std::vector<Index>> neighbours(mesh.positions.size());
  for (const Triangle& t : mesh.faces) {
    for (int k = 0; k < 3; ++k) neighbours[t[k]].push_back(t[next_corner(k)]);
  }
  std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
  before.assign(mesh.positions.size(), kNone);
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const Index v : sources) {
    distance[v] = 0;
    queue.emplace(0, v);
  }
  while (!queue.empty()) {
    const auto [reached, v] = queue.top();
    queue.pop();
    if (reached > distance[v]) continue;
    for (const Index w : neighbours[v]) {
      const double through = reached + (mesh.positions[w] - mesh.positions[v]).norm();
      if (!(through < distance[w])) continue;
      distance[w] = through;
      before[w] = v;
      queue.emplace(through, w);
    }
  }
  return distance;
}

/// Seams of a closed surface through `points` vertices, each the farthest from those before it, and
/// joined to the seams so far by a shortest path: those through more points contain those through
/// fewer.
inline Seams seams_through(const meshes::TriangleList& mesh, int points) {
  Seams seams;
  std::vector<Index> before;
  const auto farthest_from = [&](const std::vector<Index>& sources) {
    const std::vector<double> apart = edge_distances(mesh, sources, before);
    return static_cast<Index>(std::max_element(apart.begin(), apart.end()) - apart.begin());
  };
  std::vector<Index> tree = {farthest_from({0})}, chosen = tree;
  for (int k = 1; k < points; ++k) {
    const Index far = farthest_from(chosen);
    chosen.push_back(far);
    edge_distances(mesh, tree, before);
    for (Index v = far; before[v] != kNone; v = before[v]) {
      seams.insert(std::minmax(v, before[v]));
      tree.push_back(v);
    }
  }
  return seams;
}

/// A band of inner radius 1 that winds up `turns` times: beyond one turn it covers itself, laid out
/// without distortion, and little has to be bent for it not to.
inline meshes::TriangleList winding(Index along, Index across, double width, double turns) {
  meshes::TriangleList mesh = meshes::grid(along, across);
  for (Vec3& p : mesh.positions) {
    const double angle = -2 * std::numbers::pi * turns * p.x(), radius = 1 + width * p.y();
    p = {radius * std::sin(angle), -radius * std::cos(angle), 0.02 * angle};
  }
  return mesh;
}

/// A saddle slit from the middle of one side to its centre: what it has too much of around there
/// makes the sides of the slit overlap.
inline meshes::TriangleList slit_saddle(Index n, double height) {
  meshes::TriangleList mesh = slit(n);
  for (Vec3& p : mesh.positions) {
    const double x = 2 * p.x() - 1, y = 2 * p.y() - 1;
    p.z() = height * (x * x - y * y);
  }
  return mesh;
}

}  // namespace beltrami::disks
