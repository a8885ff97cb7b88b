#include "repair/repair.h"

#include <algorithm>
#include <cmath>

#include "exact/certificate.h"
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

  /// The faces within `rings` vertex rings of a face, in increasing order.
  std::vector<Index> faces_around(Index face, int rings) const {
    std::vector<Index> found{face}, front{face};
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<Index> reached;
      for (const Index f : front) {
        for (const Index v : mesh_.faces[f]) {
          mesh_.for_each_outgoing(v, [&](Index h) { reached.push_back(h / 3); });
        }
      }
      std::sort(reached.begin(), reached.end());
      reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
      front.clear();
      std::set_difference(reached.begin(), reached.end(), found.begin(), found.end(),
                          std::back_inserter(front));
      found.insert(found.end(), front.begin(), front.end());
      std::sort(found.begin(), found.end());
    }
    return found;
  }

  bool fix_patch(Index face, int rings) {
    const std::vector<Index> patch = faces_around(face, rings);
    std::vector<Index> vertices;
    for (const Index f : patch) {
      vertices.insert(vertices.end(), mesh_.faces[f].begin(), mesh_.faces[f].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto local = [&](Index v) {
      return static_cast<Index>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                vertices.begin());
    };
    std::vector<Triangle> faces;
    std::vector<RestTriangle> rest;
    for (const Index f : patch) {
      const Triangle& t = mesh_.faces[f];
      faces.push_back({local(t[0]), local(t[1]), local(t[2])});
      rest.push_back(rest_[f]);
    }
    std::vector<Vec2> uvs(vertices.size());
    std::vector<bool> fixed(vertices.size(), false);
    bool moves_boundary = false;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      uvs[i] = uvs_[vertices[i]];
      mesh_.for_each_outgoing(vertices[i], [&](Index h) {
        if (!std::binary_search(patch.begin(), patch.end(), h / 3)) fixed[i] = true;
      });
      moves_boundary = moves_boundary || (!fixed[i] && mesh_.on_boundary[vertices[i]]);
    }
    // A patch that is the whole mesh would drift.
    if (std::find(fixed.begin(), fixed.end(), true) == fixed.end()) fixed[0] = true;
    if (!untangle(faces, rest, fixed, uvs)) return false;
    exchange(vertices, uvs);
    if (!moves_boundary) return true;
    const std::int64_t crossings = count_crossings(mesh_.boundary, uvs_).count;
    if (crossings > crossings_) {
      exchange(vertices, uvs);
      return false;
    }
    crossings_ = crossings;
    return true;
  }

  void exchange(const std::vector<Index>& vertices, std::vector<Vec2>& uvs) {
    for (std::size_t i = 0; i < vertices.size(); ++i) std::swap(uvs_[vertices[i]], uvs[i]);
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
