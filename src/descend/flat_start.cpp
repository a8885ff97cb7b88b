#include "descend/flat_start.h"

#include <Eigen/Geometry>
#include <queue>
#include <utility>

#include "base/types.h"

namespace beltrami {
namespace {

Complex to_complex(const Vec2& w) {
  return {w.x(), w.y()};
}

/// Places corner `k` of a face whose other two corners are placed, as far from them as at rest.
Vec2 apex(const RestTriangle& rest, int k, const Vec2& after, const Vec2& before) {
  const Complex rest_after = rest.corner(next_corner(k)),
                rest_before = rest.corner(previous_corner(k));
  const Complex edge = to_complex(before) - to_complex(after), rest_edge = rest_before - rest_after;
  const double length = modulus(edge) * modulus(rest_edge);
  const Complex turn = length > 0 ? edge * std::conj(rest_edge) / length : Complex(1);
  // From the middle of the edge, so that no end is preferred.
  const Complex middle = 0.5 * (to_complex(before) + to_complex(after));
  const Complex place = middle + turn * (rest.corner(k) - 0.5 * (rest_after + rest_before));
  return {place.real(), place.imag()};
}

/// Ends with nothing at the first face of which may_stop(face, uvs) holds.
template <class MayStop>
std::vector<Vec2> unfold(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                         const MayStop& may_stop) {
  std::vector<Vec2> uvs(mesh.positions.size(), Vec2::Zero());
  std::vector<bool> placed(mesh.positions.size(), false), reached(mesh.faces.size(), false);
  const auto place = [&](Index v, const Vec2& w) {
    if (!placed[v]) uvs[v] = w;
    placed[v] = true;
  };
  for (int k = 0; k < 3; ++k) {
    const Complex corner = rest[0].corner(k);
    place(mesh.faces[0][k], {corner.real(), corner.imag()});
  }
  // Over the longest edge first: over a short one the direction is lost in rounding.
  std::priority_queue<std::pair<double, Index>> queue;
  const auto leave = [&](Index face) {
    reached[face] = true;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index twin = mesh.twin[h];
      if (twin == kNone || reached[twin / 3]) continue;
      queue.emplace((mesh.positions[mesh.target(h)] - mesh.positions[mesh.origin(h)]).norm(), twin);
    }
  };
  leave(0);
  while (!queue.empty()) {
    const Index twin = queue.top().second;
    queue.pop();
    const Index face = twin / 3;
    if (reached[face]) continue;
    const int corner = previous_corner(twin % 3);
    const Triangle& t = mesh.faces[face];
    place(t[corner],
          apex(rest[face], corner, uvs[t[next_corner(corner)]], uvs[t[previous_corner(corner)]]));
    if (may_stop(t, uvs)) return {};
    leave(face);
  }
  return uvs;
}

}  // namespace

std::vector<Vec2> projection(const DiskMesh& mesh) {
  Vec3 normal = Vec3::Zero();
  for (const Triangle& t : mesh.faces) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    normal += (b - a).cross(c - a);
  }
  // Along the axis nearest to the plane first, so that a mesh in a coordinate plane keeps its
  // numbers.
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  Vec3 first = Vec3::Unit(least) - normal[least] / normal.squaredNorm() * normal;
  first.normalize();
  const Vec3 second = normal.cross(first).normalized();
  std::vector<Vec2> uvs;
  uvs.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) uvs.emplace_back(first.dot(p), second.dot(p));
  return uvs;
}

std::vector<Vec2> unfolding(const DiskMesh& mesh, const std::vector<RestTriangle>& rest) {
  return unfold(mesh, rest, [](const Triangle&, const std::vector<Vec2>&) { return false; });
}

std::vector<Vec2> unflipped_unfolding(const DiskMesh& mesh, const std::vector<RestTriangle>& rest) {
  return unfold(mesh, rest, [](const Triangle& t, const std::vector<Vec2>& uvs) {
    const Vec2 first = uvs[t[1]] - uvs[t[0]], second = uvs[t[2]] - uvs[t[0]];
    return first.x() * second.y() < first.y() * second.x();
  });
}

}  // namespace beltrami
