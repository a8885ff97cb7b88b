#include "repair/touching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exact/certificate.h"
#include "exact/crossings.h"

namespace beltrami {
namespace {

/// Distances that are tried, of the diagonal of the map, each so many times the one before: from
/// the noise that solvers leave to what no eye sees.
constexpr double kLeastDistance = 0x1p-30, kMostDistance = 0x1p-14, kStep = 4;
/// What moved may meet what did not: then this moves as well, in so many rounds.
constexpr int kRounds = 8;
/// The tip of a spike moves so many times as far at most as its sides.
constexpr double kMostMiter = 4;

/// Where a corner goes when the sides before and after it move to their left by 1. The tip of a
/// slit stays, where it would have to go back along the slit.
Vec2 inwards(const Vec2& before, const Vec2& corner, const Vec2& after) {
  const auto left = [](const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    const double length = along.norm();
    return length > 0 ? Vec2(-along.y() / length, along.x() / length) : Vec2(0, 0);
  };
  const Vec2 a = left(before, corner), b = left(corner, after);
  const Vec2 sum = a + b;
  const bool is_reflex = a.x() * b.y() - a.y() * b.x() < 0;
  if (is_reflex) return sum / std::max(1 + a.dot(b), 0.5);
  const double size = sum.norm();
  // Of a spike that has no width the sides are opposite, and inwards is back along them.
  const Vec2 along = size > 1e-9 ? Vec2(sum / size) : Vec2(-a.y(), a.x());
  return along * std::min(2 / std::max(size, 1e-9), kMostMiter);
}

}  // namespace

std::optional<std::vector<Vec2>> with_sides_apart(const std::vector<Index>& loop,
                                                  const std::vector<Vec2>& uvs, double distance,
                                                  const std::function<Vec2(const Vec2&)>& snap) {
  const auto count = static_cast<Index>(loop.size());
  std::vector<Vec2> moved = uvs;
  std::vector<bool> moves(loop.size(), false);
  for (int round = 0; round <= kRounds; ++round) {
    const auto pairs = find_crossings(loop, moved);
    if (pairs.empty()) return moved;
    bool more = false;
    for (const auto& pair : pairs) {
      for (const Index edge : pair) {
        for (const Index i : {edge, (edge + 1) % count}) {
          if (moves[i]) continue;
          moves[i] = more = true;
          const Vec2& corner = uvs[loop[i]];
          const Vec2 way =
              inwards(uvs[loop[(i + count - 1) % count]], corner, uvs[loop[(i + 1) % count]]);
          moved[loop[i]] = snap(corner + distance * way);
        }
      }
    }
    if (!more) return std::nullopt;
  }
  return std::nullopt;
}

bool open_touching_sides(const DiskMesh& mesh, const Work& work, std::vector<Vec2>& uvs) {
  Eigen::AlignedBox2d box;
  for (const Vec2& w : uvs) box.extend(w);
  const double size = box.diagonal().norm();
  if (!std::isfinite(size)) return false;
  for (double share = kLeastDistance; share <= kMostDistance; share *= kStep) {
    work.report(0);
    auto moved =
        with_sides_apart(mesh.boundary, uvs, share * size, [](const Vec2& place) { return place; });
    if (!moved) continue;
    if (!non_positive_faces(mesh.faces, *moved, work).empty()) return false;
    uvs.swap(*moved);
    return true;
  }
  return false;
}

}  // namespace beltrami
