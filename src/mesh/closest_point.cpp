#include "mesh/closest_point.h"

#include <Eigen/Geometry>
#include <limits>

namespace beltrami {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();

/// Of the distance to a box: what its rounding, and that of a point on a face within, may differ
/// by.
constexpr double kRounding = 1e-12;

/// a / (a + b) for non-negative a and b, of which one at least should not be zero.
double share(double a, double b) {
  return a + b > 0 ? a / (a + b) : 0.0;
}

}  // namespace

std::array<double, 3> closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                          const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double t = share(d1, -d3);
    return {1 - t, t, 0};
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = share(d2, -d6);
    return {1 - t, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = share(d4 - d3, d5 - d6);
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {1, 0, 0};
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

ClosestPoint::ClosestPoint(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces)
    : positions_(positions), faces_(faces), normals_(faces.size()), tree_(positions, faces) {
  for (Index f = 0; f < size_of(faces); ++f) {
    const Vec3 &a = positions[faces[f][0]], &b = positions[faces[f][1]],
               &c = positions[faces[f][2]];
    normals_[f] = (b - a).cross(c - a);
  }
}

void ClosestPoint::consider(const Vec3& point, const Vec3* normal, Index face,
                            SurfacePoint& best) const {
  if (normal && !(normals_[face].dot(*normal) > 0)) return;
  const Vec3 &a = positions_[faces_[face][0]], &b = positions_[faces_[face][1]],
             &c = positions_[faces_[face][2]];
  const auto w = closest_on_triangle(point, a, b, c);
  const double distance_sq = (w[0] * a + w[1] * b + w[2] * c - point).squaredNorm();
  if (distance_sq < best.distance_sq || (distance_sq == best.distance_sq && face < best.face)) {
    best = {face, w, distance_sq};
  }
}

SurfacePoint ClosestPoint::search(const Vec3& point, const Vec3* normal, double reach_sq,
                                  Index seed) const {
  SurfacePoint best;
  best.distance_sq = reach_sq;
  if (seed != kNone) consider(point, normal, seed, best);
  struct Entry {
    Index node;
    double distance_sq;
  };
  const std::vector<FaceTree::Node>& nodes = tree_.nodes;
  std::array<Entry, FaceTree::kMostEntries> stack;
  int top = 0;
  stack[top++] = {0, nodes[0].box.squaredExteriorDistance(point)};
  while (top > 0) {
    const Entry entry = stack[--top];
    // Equal distances are visited too: the smaller face wins whatever the seed was.
    if ((1 - kRounding) * entry.distance_sq > best.distance_sq) continue;
    const FaceTree::Node& node = nodes[entry.node];
    if (node.count > 0) {
      for (Index i = node.first; i < node.first + node.count; ++i) {
        consider(point, normal, tree_.order[i], best);
      }
      continue;
    }
    const Entry left{node.first, nodes[node.first].box.squaredExteriorDistance(point)};
    const Entry right{node.first + 1, nodes[node.first + 1].box.squaredExteriorDistance(point)};
    const bool left_first = left.distance_sq <= right.distance_sq;
    stack[top++] = left_first ? right : left;
    stack[top++] = left_first ? left : right;
  }
  return best;
}

SurfacePoint ClosestPoint::find(const Vec3& point, const Vec3& normal, Index seed) const {
  const SurfacePoint best = search(point, &normal, kAnywhere, seed);
  return best.face != kNone ? best : search(point, nullptr, kAnywhere, seed);
}

SurfacePoint ClosestPoint::find_within(const Vec3& point, const Vec3& normal, double reach,
                                       Index seed) const {
  return search(point, &normal, reach * reach, seed);
}

}  // namespace beltrami
