#include "cut/given.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

using Edge = std::array<Index, 2>;  // the lesser end first

Edge edge_between(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

/// The given edges between welded vertices, in order.
std::vector<Edge> sorted_edges(const Admitted& admitted, const GivenCuts& cuts) {
  std::vector<Edge> edges;
  for (const auto& [a, b] : cuts.edges) {
    edges.push_back(edge_between(admitted.welded(a), admitted.welded(b)));
  }
  sort_interruptibly(edges.begin(), edges.end(), std::less<>());
  return edges;
}

Vec3 normal_of(const Surface& surface, Index face) {
  const auto [a, b, c] = surface.faces[face];
  const Vec3& p = surface.positions[a];
  return (surface.positions[b] - p).cross(surface.positions[c] - p);
}

/// Whether the normals of the faces on both sides of an edge turn by more than the angle.
bool is_hard(const Surface& surface, Index halfedge, double cosine) {
  const Vec3 one = normal_of(surface, halfedge / 3),
             other = normal_of(surface, surface.twin[halfedge] / 3);
  return one.dot(other) < cosine * std::sqrt(one.squaredNorm() * other.squaredNorm());
}

/// Why an edge is a seam, told at the lesser of its half-edges.
enum class Reason : std::uint8_t { kNone, kHard, kAsked };

/// Takes back the marks of creases that are trees of hard edges alone and meet no border: each
/// would be a slit, of which only the search can tell whether it is worth anything.
void drop_slits(const Surface& surface, const std::vector<Reason>& reasons, EdgeMarks& marks) {
  std::vector<Index> parent(surface.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> holds(parent.size(), false);  // at roots: a loop or a border, or other marks
  PollSometimes poll;
  for (Index h = 0; h < size_of(reasons); ++h) {
    poll();
    if (reasons[h] == Reason::kNone) continue;
    const Index a = root(surface.origin(h)), b = root(surface.target(h));
    const bool is_held = reasons[h] == Reason::kAsked || a == b || holds[a] || holds[b] ||
                         surface.on_boundary[surface.origin(h)] ||
                         surface.on_boundary[surface.target(h)];
    parent[a] = b;
    holds[b] = is_held;
  }
  for (Index h = 0; h < size_of(reasons); ++h) {
    if (reasons[h] != Reason::kHard || holds[root(surface.origin(h))]) continue;
    marks[h] = marks[surface.twin[h]] = false;
  }
}

}  // namespace

EdgeMarks given_marks(const Admitted& admitted, const GivenCuts& cuts, const Work& work) {
  const Surface& surface = admitted.surface;
  const std::vector<Edge> edges = sorted_edges(admitted, cuts);
  const bool by_angle = cuts.hard_angle < std::numbers::pi;
  const double cosine = portable::cos(cuts.hard_angle);
  const auto input_vertex = [&](Index v) { return admitted.input_vertex[v]; };
  // Of the corner that a half-edge starts from.
  const auto uv = [&](Index h) {
    const Index face = h / 3;
    return cuts.corner_uvs[3 * static_cast<std::size_t>(admitted.input_face[face]) +
                           static_cast<std::size_t>(admitted.input_corner(face, h % 3))];
  };
  const auto is_asked = [&](Index h, Index twin) {
    if (!edges.empty() && std::binary_search(edges.begin(), edges.end(),
                                             edge_between(input_vertex(surface.origin(h)),
                                                          input_vertex(surface.target(h))))) {
      return true;
    }
    if (!cuts.labels.empty() &&
        cuts.labels[admitted.input_face[h / 3]] != cuts.labels[admitted.input_face[twin / 3]]) {
      return true;
    }
    return !cuts.corner_uvs.empty() &&
           (uv(h) != uv(Surface::next(twin)) || uv(Surface::next(h)) != uv(twin));
  };
  // Bytes, for neighbouring bits cannot be written side by side.
  std::vector<Reason> reasons(surface.twin.size(), Reason::kNone);
  parallel_for(work, size_of(surface.twin), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      const Index twin = surface.twin[h];
      if (twin == kNone || h > twin) continue;
      if (is_asked(h, twin)) {
        reasons[h] = Reason::kAsked;
      } else if (by_angle && is_hard(surface, h, cosine)) {
        reasons[h] = Reason::kHard;
      }
    }
  });
  EdgeMarks marks(surface.twin.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (reasons[h] != Reason::kNone) mark_edge(surface, h, marks);
  }
  if (by_angle) drop_slits(surface, reasons, marks);
  return marks;
}

}  // namespace beltrami
