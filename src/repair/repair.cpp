#include "repair/repair.h"

#include <algorithm>
#include <limits>

#include "exact/certificate.h"
#include "repair/patch.h"
#include "repair/untangle.h"

namespace beltrami {
namespace {

/// A moved vertex must leave every face of its ring at least this share of the mean one: tiny
/// positive areas pass the exact test and give energies of 1e25.
constexpr double kLeastAreaShare = 1e-3;
constexpr std::array<int, 4> kPatchRings = {2, 4, 6, 8};

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The part of a polygon to the left of the line from a to b (Sutherland & Hodgman 1974).
std::vector<Vec2> clip(const std::vector<Vec2>& polygon, const Vec2& a, const Vec2& b) {
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double dp = cross(a, b, p), dq = cross(a, b, q);
    if (dp >= 0) result.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) result.push_back(p + dp / (dp - dq) * (q - p));
  }
  return result;
}

/// The points from which the whole polygon is visible; empty if there are none.
std::vector<Vec2> kernel(const std::vector<Vec2>& polygon) {
  Vec2 low = polygon.front(), high = polygon.front();
  for (const Vec2& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<Vec2> region = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (std::size_t i = 0; i < polygon.size() && !region.empty(); ++i) {
    region = clip(region, polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
  }
  return region;
}

/// Area centroid of a convex polygon; false if it has no area.
bool centroid(const std::vector<Vec2>& polygon, Vec2& result) {
  double area = 0;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double part = cross(polygon[0], polygon[i - 1], polygon[i]);
    area += part;
    sum += part * (polygon[0] + polygon[i - 1] + polygon[i]) / 3;
  }
  if (!(area > 0)) return false;
  result = sum / area;
  return true;
}

class Repair {
 public:
  Repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
         int threads)
      : mesh_(mesh), rest_(rest), uvs_(uvs), threads_(threads) {}

  RepairResult run(const Checkpoint& checkpoint) {
    RepairResult result;
    std::vector<Index> bad = non_positive_faces(mesh_.faces, uvs_, threads_);
    result.flips_before = size_of(bad);
    for (const Index face : bad) {
      for (const Index v : mesh_.faces[face]) {
        if (!positive(face) && move_to_kernel(v)) ++result.kernel_fixes;
      }
    }
    if (!bad.empty()) bad = non_positive_faces(mesh_.faces, uvs_, threads_);
    if (!bad.empty()) crossings_ = count_crossings(mesh_.boundary, uvs_).count;
    for (std::size_t level = 0; level < kPatchRings.size() && !bad.empty(); ++level) {
      std::size_t done = 0;
      for (const Index face : bad) {
        checkpoint((static_cast<double>(level) + static_cast<double>(done++) / bad.size()) /
                   kPatchRings.size());
        if (!positive(face) && fix_patch(face, kPatchRings[level])) ++result.patch_fixes;
      }
      bad = non_positive_faces(mesh_.faces, uvs_, threads_);
    }
    result.flips_after = size_of(bad);
    return result;
  }

 private:
  bool positive(Index face) const {
    const Triangle& t = mesh_.faces[face];
    return orientation(uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]) > 0;
  }

  bool move_to_kernel(Index vertex) {
    if (mesh_.on_boundary[vertex]) return false;
    std::vector<Vec2> ring;
    mesh_.for_each_outgoing(vertex, [&](Index h) { ring.push_back(uvs_[mesh_.target(h)]); });
    Vec2 target;
    if (!centroid(kernel(ring), target)) return false;
    double ring_area = 0, least = std::numeric_limits<double>::infinity();
    bool all_positive = true;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const double area = cross(target, a, b);
      ring_area += area;
      least = std::min(least, area);
      all_positive = all_positive && orientation(target, a, b) > 0;
    }
    if (!all_positive || least < kLeastAreaShare * ring_area / ring.size()) return false;
    uvs_[vertex] = target;
    return true;
  }

  bool fix_patch(Index face, int rings) {
    Patch patch = cut_patch(mesh_, rest_, uvs_, face, rings);
    if (!untangle(patch.faces, patch.rest, patch.fixed, patch.uvs)) return false;
    patch.exchange(uvs_);
    if (!patch.moves_boundary) return true;
    const std::int64_t crossings = count_crossings(mesh_.boundary, uvs_).count;
    if (crossings > crossings_) {
      patch.exchange(uvs_);
      return false;
    }
    crossings_ = crossings;
    return true;
  }

  const DiskMesh& mesh_;
  const std::vector<RestTriangle>& rest_;
  std::vector<Vec2>& uvs_;
  const int threads_;
  std::int64_t crossings_ = 0;
};

}  // namespace

RepairResult repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, int threads, const Checkpoint& checkpoint) {
  return Repair(mesh, rest, uvs, threads).run(checkpoint);
}

}  // namespace beltrami
