#include "cut/creases.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/interrupt.h"
#include "base/vectors.h"

namespace beltrami {
namespace {

Vec3 normal_of(const Surface& surface, Index face) {
  const auto [a, b, c] = surface.faces[face];
  const Vec3& p = surface.positions[a];
  return (surface.positions[b] - p).cross(surface.positions[c] - p);
}

}  // namespace

bool is_crease(const Surface& surface, Index halfedge, double cosine) {
  const Vec3 one = normal_of(surface, halfedge / 3),
             other = normal_of(surface, surface.twin[halfedge] / 3);
  return one.dot(other) < cosine * std::sqrt(one.squaredNorm() * other.squaredNorm());
}

void drop_slits(const Surface& surface, const EdgeMarks& creases, EdgeMarks& marks) {
  std::vector<Index> parent(surface.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> holds(parent.size(), false);  // at roots: a loop or a border, or other marks
  PollSometimes poll;
  for (Index h = 0; h < size_of(marks); ++h) {
    poll();
    if (!marks[h] || surface.edge(h) != h) continue;
    const Index from = surface.origin(h), to = surface.target(h);
    const Index a = root(from), b = root(to);
    const bool is_held = !creases[h] || a == b || holds[a] || holds[b] ||
                         surface.on_boundary[from] || surface.on_boundary[to];
    parent[a] = b;
    holds[b] = is_held;
  }
  for (Index h = 0; h < size_of(marks); ++h) {
    if (creases[h] && !holds[root(surface.origin(h))]) marks[h] = false;
  }
}

}  // namespace beltrami
