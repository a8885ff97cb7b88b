#include "admit/whole_polygons.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Calls visit(begin, end) for the faces of each polygon that are on the surface.
template <class Visit>
void for_each_polygon(const Admitted& admitted, const PolygonParts& polygons, const Visit& visit) {
  const std::vector<Index>& face = admitted.input_face;
  PollSometimes poll;
  for (Index begin = 0, end = 0; begin < size_of(face); begin = end) {
    poll();
    end = begin + 1;
    while (end < size_of(face) && polygons.polygon[face[end]] == polygons.polygon[face[begin]]) {
      ++end;
    }
    visit(begin, end);
  }
}

/// Whether diagonals lead from the first of the faces [begin, end) to all of them.
bool is_whole(const Admitted& admitted, const PolygonParts& polygons, Index begin, Index end) {
  std::vector<bool> seen(end - begin, false);
  std::vector<Index> reached = {begin};
  seen[0] = true;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (Index h = 3 * reached[i]; h < 3 * reached[i] + 3; ++h) {
      const Index twin = admitted.surface.twin[h];
      if (twin == kNone || twin / 3 < begin || twin / 3 >= end || seen[twin / 3 - begin]) continue;
      if (!is_inside_polygon(admitted, polygons, h, twin)) continue;
      seen[twin / 3 - begin] = true;
      reached.push_back(twin / 3);
    }
  }
  return size_of(reached) == end - begin;
}

/// The corners of a piece that is a disk without inner vertices, in their order around it.
std::vector<Index> ring_of(const Surface& surface, Index begin, Index end) {
  std::vector<Index> ring;
  const auto last = surface.twin.begin() + 3 * end;
  const auto found = std::find(surface.twin.begin() + 3 * begin, last, kNone);
  if (found == last) return {};
  const auto first = static_cast<Index>(found - surface.twin.begin());
  Index h = first;
  do {
    ring.push_back(surface.origin(h));
    h = Surface::next(h);
    while (surface.twin[h] != kNone) h = Surface::next(surface.twin[h]);
  } while (h != first);
  return size_of(ring) == end - begin + 2 ? ring : std::vector<Index>();
}

}  // namespace

bool is_inside_polygon(const Admitted& admitted, const PolygonParts& polygons, Index h,
                       Index twin) {
  const auto is_diagonal = [&](Index of) {
    const Index face = of / 3;
    const int k = admitted.reversed[face] ? 2 - of % 3 : of % 3;
    return polygons.is_diagonal(admitted.input_face[face], k);
  };
  const auto polygon = [&](Index of) { return polygons.polygon[admitted.input_face[of / 3]]; };
  return polygon(h) == polygon(twin) && is_diagonal(h) && is_diagonal(twin);
}

bool mark_torn(const Admitted& admitted, const PolygonParts& polygons, std::vector<bool>& apart) {
  bool is_any = false;
  if (polygons.polygon.empty()) return is_any;
  for_each_polygon(admitted, polygons, [&](Index begin, Index end) {
    const Index face = admitted.input_face[begin];
    if (end - begin < 2 || apart[face] || is_whole(admitted, polygons, begin, end)) return;
    is_any = true;
    const Index polygon = polygons.polygon[face];
    Index first = face, last = face;  // with those that the surface lacks
    while (first > 0 && polygons.polygon[first - 1] == polygon) --first;
    while (last < size_of(apart) && polygons.polygon[last] == polygon) ++last;
    std::fill(apart.begin() + first, apart.begin() + last, true);
  });
  return is_any;
}

void regularize(const Admitted& admitted, const PolygonParts& polygons,
                const std::vector<bool>& apart, const std::vector<bool>& without,
                Surface& surface) {
  for_each_polygon(admitted, polygons, [&](Index begin, Index end) {
    const auto is_flat = [&](Index f) { return without[admitted.input_face[f]]; };
    if (!apart[admitted.input_face[begin]]) return;
    double area = 0;
    bool is_bad = false;
    for (Index f = begin; f < end; ++f) {
      const auto [i, j, k] = surface.faces[f];
      area += triangle_area(surface.positions[i], surface.positions[j], surface.positions[k]);
      is_bad = is_bad || is_flat(f);
    }
    const std::vector<Index> ring = is_bad ? ring_of(surface, begin, end) : std::vector<Index>();
    if (ring.empty()) return;
    const double turn = 2 * std::numbers::pi / static_cast<double>(ring.size());
    const double radius =  // infinite where the square of a length is
        std::sqrt(2 * area / (static_cast<double>(ring.size()) * portable::sin(turn)));
    const Vec3 centre = surface.positions[ring[0]];
    if (!(radius > 0) || !std::isfinite(radius)) return;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const double angle = turn * static_cast<double>(i);
      surface.positions[ring[i]] =
          centre + radius * Vec3(portable::cos(angle), portable::sin(angle), 0);
    }
  });
}

}  // namespace beltrami
