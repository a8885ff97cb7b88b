#include "mesh/rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace beltrami {
namespace {

/// Barycentric coordinates above which a place counts as on a face: edges are met by both sides,
/// whatever rounding makes of them.
constexpr double kHair = -1e-12;
/// Beyond every reach.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where the line of a ray meets a face.
struct Meeting {
  double distance = 0;
  std::array<double, 3> barycentric{};
  bool from_outside = false;
};

/// Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection (1997). False for rays
/// along the face, and beside it.
bool meet(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c, Meeting& found) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 across = ray.direction.cross(ac);
  const double determinant = ab.dot(across);
  if (!(std::abs(determinant) > 0)) return false;
  const Vec3 from = ray.origin - a;
  const double v = from.dot(across) / determinant;
  if (!(v >= kHair && v <= 1 - kHair)) return false;
  const Vec3 turned = from.cross(ab);
  const double w = ray.direction.dot(turned) / determinant;
  if (!(w >= kHair && v + w <= 1 - kHair)) return false;
  found = {ac.dot(turned) / determinant, {1 - v - w, v, w}, determinant > 0};
  return true;
}

/// Where a ray enters a box, or kNever where it goes by.
double entry(const Vec3& origin, const Vec3& per_direction, double reach,
             const Eigen::AlignedBox3d& box) {
  double first = 0, last = reach;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const double low = (box.min()[d] - origin[d]) * per_direction[d];
    const double high = (box.max()[d] - origin[d]) * per_direction[d];
    // A ray within a side of the box has one that is no number, and is not kept out by it: min and
    // max give their first argument then, and so the order of these matters.
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(high, low));
  }
  constexpr double kRounding = 1e-12;  // of the way to the box
  return first <= last * (1 + kRounding) ? first : kNever;
}

}  // namespace

Rays::Rays(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
           const FaceTree& tree)
    : positions_(positions), faces_(faces), tree_(tree) {}

template <class Visit>
void Rays::search(const Ray& ray, const Visit& visit) const {
  struct Entry {
    Index node;
    double distance;
  };
  const std::vector<FaceTree::Node>& nodes = tree_.nodes;
  // What is infinite is so upwards: a box whose side the ray lies in is met then.
  Vec3 per_direction = ray.direction.cwiseInverse();
  for (double& x : per_direction) x = std::isinf(x) ? std::abs(x) : x;
  double reach = ray.reach;
  std::array<Entry, FaceTree::kMostEntries> stack;
  std::size_t top = 0;
  stack[top++] = {0, entry(ray.origin, per_direction, reach, nodes[0].box)};
  while (top > 0) {
    const Entry at = stack[--top];
    if (at.distance > reach) continue;
    const FaceTree::Node& node = nodes[at.node];
    if (node.count == 0) {
      const Index left = node.first, right = node.first + 1;
      Entry near{left, entry(ray.origin, per_direction, reach, nodes[left].box)};
      Entry far{right, entry(ray.origin, per_direction, reach, nodes[right].box)};
      if (far.distance < near.distance) std::swap(near, far);
      if (far.distance <= reach) stack[top++] = far;
      if (near.distance <= reach) stack[top++] = near;
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      const Index face = tree_.order[i];
      const auto& [a, b, c] = faces_[face];
      Meeting found;
      if (!meet(ray, positions_[a], positions_[b], positions_[c], found)) continue;
      if (!(found.distance >= 0 && found.distance <= reach)) continue;
      reach = visit(face, found);
      if (reach < 0) return;
    }
  }
}

SurfacePoint Rays::first_from_outside(const Ray& ray) const {
  SurfacePoint first;
  double reach = ray.reach;
  search(ray, [&](Index face, const Meeting& found) {
    const bool sooner = found.distance < reach || first.face == kNone || face < first.face;
    if (found.from_outside && sooner) {
      reach = found.distance;
      first = {face, found.barycentric, reach * reach};
      for (double& weight : first.barycentric) weight = std::clamp(weight, 0.0, 1.0);
    }
    return reach;
  });
  return first;
}

bool Rays::is_stopped(const Ray& ray) const {
  bool stopped = false;
  search(ray, [&](Index, const Meeting&) {
    stopped = true;
    return -1.0;
  });
  return stopped;
}

}  // namespace beltrami
