#include "admit/orient.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <utility>

#include "admit/continue_sheets.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/disk_mesh.h"
#include "mesh/edges.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// Faces that run against the rest of their component are parted from it up to this length of their
/// border, in roots of its area: less than half of the seam of a sphere (1.8), and than the edge
/// between two right triangles (1). So a few keep their winding for little, and a soup of random
/// windings stays whole.
constexpr double kShortBorder = 0.75;

/// The faces of a component, and which of them are to be turned.
struct Turns {
  std::span<const Index> component;
  std::vector<bool>& reversed;
};

/// Turns all faces over if that leaves more of them as they are.
void keep_majority(Turns turns) {
  std::size_t count = 0;
  PollSometimes poll;
  for (const Index f : turns.component) {
    poll();
    count += turns.reversed[f] ? 1 : 0;
  }
  if (2 * count <= turns.component.size()) return;
  for (const Index f : turns.component) turns.reversed[f] = !turns.reversed[f];
}

/// Parts the faces to be turned from the others where their border is short: none are to be then.
void part_if_short(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                   Turns turns, std::vector<Index>& twin) {
  const auto is_turned = [&](Index f) -> bool { return turns.reversed[f]; };
  if (std::none_of(turns.component.begin(), turns.component.end(), is_turned)) return;
  double greatest = 0, area = 0, length = 0;
  PollSometimes poll;
  for (const Index f : turns.component) {
    poll();
    for (const Index v : faces[f]) {
      greatest = std::max(greatest, positions[v].cwiseAbs().maxCoeff());
    }
  }
  std::vector<Index> border;
  for (const Index f : turns.component) {
    poll();
    std::array<Vec3, 3> corner;  // of about unit size
    for (int k = 0; k < 3; ++k) corner[k] = positions[faces[f][k]] / greatest;
    area += triangle_area(corner[0], corner[1], corner[2]);
    if (!turns.reversed[f]) continue;
    for (int k = 0; k < 3; ++k) {
      const Index other = twin[3 * f + k];
      if (other == kNone || turns.reversed[other / 3]) continue;
      border.push_back(3 * f + k);
      length += (corner[next_corner(k)] - corner[k]).norm();
    }
  }
  if (!(length <= kShortBorder * std::sqrt(area))) return;
  for (const Index h : border) twin[h] = twin[twin[h]] = kNone;
  for (const Index f : turns.component) turns.reversed[f] = false;
}

/// The half-edges of one edge, by their layers and polygons.
using Sides = std::vector<std::array<Index, 3>>;  // layer, polygon, half-edge

/// Calls join for the pairs of one polygon, takes them out and returns how many are left at
/// [first, last).
template <class Join>
std::size_t join_in_polygons(Sides& sides, std::size_t first, std::size_t last, const Join& join) {
  std::size_t left = first;
  for (std::size_t i = first, next = 0; i < last; i = next) {
    next = i + 1;
    while (next < last && sides[next][1] == sides[i][1]) ++next;
    if (next - i == 2) {
      join(sides[i][2], sides[i + 1][2]);
    } else {
      for (; i < next; ++i) sides[left++] = sides[i];
    }
  }
  return left - first;
}

/// Half-edge h, where its face is turned over.
Index turned(Index h) {
  return h + 2 - 2 * (h % 3);
}

}  // namespace

Gluing glue(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
            const std::vector<Index>& layers, std::span<const Index> polygons, const Work& work) {
  Gluing gluing;
  parallel_assign(work, gluing.twin, 3 * faces.size(), kNone);
  const auto join = [&](Index one, Index other) {
    gluing.twin[one] = other;
    gluing.twin[other] = one;
  };
  std::vector<Crowd> crowds;
  std::mutex mutex;
  std::atomic<bool> joined{false};
  HalfedgeBuckets buckets = sort_halfedges(size_of(positions), faces, work);
  for_each_edge(work, buckets, [&](std::span<const Spoke> edge) {
    if (edge.size() < 2) return;
    if (edge.size() == 2) {
      const Index one = edge[0].halfedge(), other = edge[1].halfedge();
      if (layers[one / 3] == layers[other / 3]) join(one, other);
      return;
    }
    Sides sides;
    for (const Spoke& spoke : edge) {
      const Index face = spoke.halfedge() / 3;
      sides.push_back({layers[face], polygons.empty() ? face : polygons[face], spoke.halfedge()});
    }
    sort_interruptibly(sides.begin(), sides.end(), std::less<>());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      while (last < sides.size() && sides[last][0] == sides[first][0]) ++last;
      const std::size_t left =
          last - first > 2 ? join_in_polygons(sides, first, last, join) : last - first;
      if (left < last - first) joined = true;
      if (left == 2) join(sides[first][2], sides[first + 1][2]);
      if (left < 3) continue;
      Crowd crowd;
      for (std::size_t i = first; i < first + left; ++i) crowd.push_back(sides[i][2]);
      const std::lock_guard lock(mutex);
      crowds.push_back(std::move(crowd));
    }
  });
  if (!crowds.empty()) continue_sheets(positions, faces, crowds, gluing.twin, work);
  gluing.crowded_edges = size_of(crowds);
  gluing.joined_in_crowds = joined || !crowds.empty();
  return gluing;
}

Gluing glue(const std::vector<Vec2>& uvs, const std::vector<Triangle>& faces,
            const std::vector<Index>& layers, std::span<const Index> polygons, const Work& work) {
  std::vector<Vec3> positions;
  positions.reserve(uvs.size());
  for (const Vec2& w : uvs) positions.emplace_back(w.x(), w.y(), 0);
  return glue(positions, faces, layers, polygons, work);
}

Orientation orient(std::vector<Triangle>& faces, std::vector<Index>& twin,
                   std::span<const Index> polygons, const Work& work,
                   const std::vector<Vec3>* positions) {
  Orientation result;
  result.reversed.assign(faces.size(), false);
  std::vector<bool>& reversed = result.reversed;
  std::vector<bool> seen(faces.size(), false);
  std::vector<Index> order;
  order.reserve(faces.size());
  PollSometimes poll;
  // Whether the face beyond is to be turned for its twin to run against h.
  const auto wanted = [&](Index h) {
    const bool alike = ends_of(faces, h)[0] == ends_of(faces, twin[h])[0];
    return reversed[h / 3] != alike;
  };
  // Adds a face, and at once the rest of its polygon, so that no other way comes first.
  const auto add = [&](Index face, bool is_reversed) {
    seen[face] = true;
    reversed[face] = is_reversed;
    order.push_back(face);
    if (polygons.empty()) return;
    for (std::size_t i = order.size() - 1; i < order.size(); ++i) {
      for (Index h = 3 * order[i]; h < 3 * order[i] + 3; ++h) {
        const Index other = twin[h] == kNone ? kNone : twin[h] / 3;
        if (other == kNone || seen[other] || polygons[other] != polygons[face]) continue;
        seen[other] = true;
        reversed[other] = wanted(h);
        order.push_back(other);
      }
    }
  };
  for (Index seed = 0; seed < size_of(faces); ++seed) {
    if (seen[seed]) continue;
    const std::size_t begin = order.size();
    const Index one_sided_before = result.one_sided_edges;
    add(seed, false);
    for (std::size_t i = begin; i < order.size(); ++i) {
      poll();
      for (int k = 0; k < 3; ++k) {
        const Index h = 3 * order[i] + k, other = twin[h];
        if (other == kNone) continue;
        if (!seen[other / 3]) {
          add(other / 3, wanted(h));
        } else if (reversed[other / 3] != wanted(h)) {
          twin[h] = twin[other] = kNone;
          ++result.one_sided_edges;
        }
      }
    }
    const Turns turns{std::span(order).subspan(begin), reversed};
    keep_majority(turns);
    // A one-sided surface has no front that windings could agree on.
    const bool has_front = result.one_sided_edges == one_sided_before;
    if (positions != nullptr && has_front) part_if_short(*positions, faces, turns, twin);
  }

  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      if (reversed[f]) {
        std::swap(faces[f][1], faces[f][2]);
        std::swap(twin[3 * f], twin[3 * f + 2]);
      }
      for (int k = 0; k < 3; ++k) {
        Index& other = twin[3 * f + k];
        if (other != kNone && reversed[other / 3]) other = turned(other);
      }
    }
  });
  return result;
}

}  // namespace beltrami
