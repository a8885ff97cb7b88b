#include "cut/given.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "cut/creases.h"
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
  enum class Reason : std::uint8_t { kNone, kHard, kAsked };
  std::vector<Reason> reasons(surface.twin.size(), Reason::kNone);
  parallel_for(work, size_of(surface.twin), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      const Index twin = surface.twin[h];
      if (twin == kNone || h > twin) continue;
      if (is_asked(h, twin)) {
        reasons[h] = Reason::kAsked;
      } else if (by_angle && is_crease(surface, h, cosine)) {
        reasons[h] = Reason::kHard;
      }
    }
  });
  EdgeMarks marks(surface.twin.size(), false), creases(marks.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    if (reasons[h] == Reason::kNone) continue;
    mark_edge(surface, h, marks);
    if (reasons[h] == Reason::kHard) mark_edge(surface, h, creases);
  }
  if (by_angle) drop_slits(surface, creases, marks);
  return marks;
}

}  // namespace beltrami
