#include "admit/admit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "admit/orient.h"
#include "admit/weld.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "mesh/split_fans.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
/// Of the largest face, or of the square of the longest edge: what rounding makes of no area at
/// all is a hundredth of it.
constexpr double kLeastArea = 1e-14;

/// Of each body, as if it were alone.
std::vector<Index> weld_bodies(const std::vector<Vec3>& positions, double distance,
                               std::span<const Index> bodies, const Work& work) {
  if (bodies.size() < 2) return weld(positions, distance, work);
  std::vector<Index> first;
  first.reserve(positions.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Index end = b + 1 < bodies.size() ? bodies[b + 1] : size_of(positions);
    const std::vector<Vec3> own(positions.begin() + bodies[b], positions.begin() + end);
    for (const Index v : weld(own, distance, work)) first.push_back(bodies[b] + v);
  }
  return first;
}

/// Names the welded vertices instead of those welded to them.
std::vector<Triangle> welded(const std::vector<Vec3>& positions, std::vector<Triangle> faces,
                             const AdmitOptions& options, const Work& work, Admitted& admitted) {
  if (!options.weld_distance) return faces;
  std::vector<Index> first = weld_bodies(positions, *options.weld_distance, options.bodies, work);
  for (Index v = 0; v < size_of(first); ++v) {
    admitted.counts.welded_vertices += first[v] != v ? 1 : 0;
  }
  if (admitted.counts.welded_vertices == 0) return faces;
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (Index& v : faces[f]) v = first[v];
    }
  });
  admitted.welded_to = std::move(first);
  return faces;
}

Index unused_vertices(Index vertex_count, const std::vector<Triangle>& faces) {
  std::vector<bool> used(vertex_count, false);
  PollSometimes poll;
  for (const Triangle& face : faces) {
    poll();
    for (const Index v : face) used[v] = true;
  }
  return static_cast<Index>(std::count(used.begin(), used.end(), false));
}

bool names_twice(const Triangle& face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// The power of two that brings the greatest coordinate to about 1: areas then neither over- nor
/// underflow. The power itself may lie beyond the numbers.
int unit_exponent(const std::vector<Vec3>& positions) {
  double greatest = 0;
  PollSometimes poll;
  for (const Vec3& p : positions) {
    poll();
    greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  }
  return greatest > 0 ? -std::ilogb(greatest) : 0;
}

struct Size {
  double area = 0, longest_edge_sq = 0;
};

/// Sizes of the faces, at about unit scale; none for those that name a vertex twice.
std::vector<Size> sizes_of(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                           const Work& work) {
  const int exponent = unit_exponent(positions);
  const double half = std::ldexp(1.0, exponent / 2),
               rest = std::ldexp(1.0, exponent - exponent / 2);
  std::vector<Size> sizes(faces.size());
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      if (names_twice(faces[f])) continue;
      std::array<Vec3, 3> corner;
      for (int k = 0; k < 3; ++k) corner[k] = positions[faces[f][k]] * half * rest;
      sizes[f].area = triangle_area(corner[0], corner[1], corner[2]);
      for (int k = 0; k < 3; ++k) {
        sizes[f].longest_edge_sq =
            std::max(sizes[f].longest_edge_sq, (corner[next_corner(k)] - corner[k]).squaredNorm());
      }
    }
  });
  return sizes;
}

/// Which faces of the input the surface lacks, and which polygons are pieces by themselves.
struct Fate {
  std::vector<bool> without;  ///< per face, whether it has no area
  std::vector<bool> apart;    ///< per face, whether its polygon is
};

/// Keeps the faces with area, in their order, and notes the others. Polygons apart keep all, with
/// vertices that are not welded. `given`: before welding.
std::vector<Triangle> faces_with_area(const std::vector<Triangle>& given,
                                      const std::vector<Triangle>& faces, const Fate& fate,
                                      Admitted& admitted) {
  std::vector<Triangle> kept;
  kept.reserve(faces.size());
  PollSometimes poll;
  for (Index f = 0; f < size_of(faces); ++f) {
    poll();
    const bool is_apart = fate.apart[f] && !names_twice(given[f]);
    if (!fate.without[f] || is_apart) {
      kept.push_back(is_apart ? given[f] : faces[f]);
      admitted.input_face.push_back(f);
      continue;
    }
    admitted.set_aside.push_back(f);
    ++(names_twice(faces[f]) ? admitted.counts.repeated_faces : admitted.counts.faces_without_area);
  }
  if (kept.empty()) {
    throw Error(Fault::kZeroArea,
                "the surface has no area: every face is degenerate (check the vertex positions)");
  }
  return kept;
}

/// Per face, the first one with the same vertices; notes the others.
std::vector<Index> firsts_of(Index vertex_count, const std::vector<Triangle>& faces,
                             const Work& work, Admitted& admitted) {
  struct Entry {
    Triangle corners;  // in increasing order
    Index face;
  };
  const std::vector<Index> order = by_least_vertex(vertex_count, faces, work);
  std::vector<Index> firsts(faces.size());
  std::iota(firsts.begin(), firsts.end(), 0);
  std::vector<Entry> entries;
  PollSometimes poll;
  for (Index i = 0; i < size_of(order);) {
    entries.clear();
    for (; i < size_of(order); ++i) {
      poll();
      Entry entry{faces[order[i]], order[i]};
      std::sort(entry.corners.begin(), entry.corners.end());
      if (!entries.empty() && entry.corners[0] != entries[0].corners[0]) break;
      entries.push_back(entry);
    }
    sort_interruptibly(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.corners, a.face) < std::tie(b.corners, b.face);
    });
    for (std::size_t e = 1, first = 0; e < entries.size(); ++e) {
      if (entries[e].corners != entries[first].corners) {
        first = e;
        continue;
      }
      firsts[entries[e].face] = entries[first].face;
      admitted.copies.push_back(
          {admitted.input_face[entries[e].face], admitted.input_face[entries[first].face]});
    }
  }
  sort_interruptibly(admitted.copies.begin(), admitted.copies.end(),
                     [](const auto& a, const auto& b) { return a.face < b.face; });
  admitted.counts.copies = size_of(admitted.copies);
  return firsts;
}

/// Of the faces that are left.
std::vector<Index> polygons_of(const Admitted& admitted, const AdmitOptions& options) {
  std::vector<Index> polygons;
  if (options.polygons.polygon.empty()) return polygons;
  polygons.reserve(admitted.input_face.size());
  for (const Index face : admitted.input_face) polygons.push_back(options.polygons.polygon[face]);
  return polygons;
}

/// Whether two of the faces [begin, end) have the same vertices.
bool has_twins(const std::vector<Triangle>& faces, Index begin, Index end) {
  std::vector<Triangle> corners(faces.begin() + begin, faces.begin() + end);
  for (Triangle& face : corners) std::sort(face.begin(), face.end());
  std::sort(corners.begin(), corners.end());
  return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

/// Every face lies above those before it that have its vertices.
struct Layers {
  std::vector<Index> of_face;
  std::vector<bool> is_copy;  ///< per face, whether its whole polygon is made of copies
};

/// Puts every polygon into one layer, so that it stays in one piece. Of one that is apart, or lies
/// on itself, each face gets a layer of its own, below 0, for its sides would be glued to each
/// other. `firsts`: per face, the first with its vertices.
Layers layer_polygons(const std::vector<Triangle>& faces, const std::vector<Index>& polygons,
                      const std::vector<Index>& firsts, const Fate& fate,
                      const Admitted& admitted) {
  Layers layers{std::vector<Index>(faces.size(), 0), std::vector<bool>(faces.size(), false)};
  std::vector<Index> next(faces.size(), 0);  // per first face, the layer above all that lie there
  for (Index begin = 0, end = 0; begin < size_of(faces); begin = end) {
    end = begin + 1;
    while (!polygons.empty() && end < size_of(faces) && polygons[end] == polygons[begin]) ++end;
    Index layer = 0, copies = 0;
    for (Index f = begin; f < end; ++f) {
      layer = std::max(layer, next[firsts[f]]);
      copies += firsts[f] != f ? 1 : 0;
    }
    const bool is_folded =
        fate.apart[admitted.input_face[begin]] || (copies > 0 && has_twins(faces, begin, end));
    for (Index f = begin; f < end; ++f) {
      layers.of_face[f] = is_folded ? -1 - f : layer;
      layers.is_copy[f] = copies == end - begin;
      next[firsts[f]] = layer + 1;
    }
  }
  return layers;
}

/// Glues the faces of polygons that are apart, or lie on themselves, where these were cut. `faces`:
/// the input's, whose vertices are not welded.
void glue_folded_polygons(const std::vector<Triangle>& faces, const PolygonParts& polygons,
                          const Admitted& admitted, const std::vector<Index>& layers,
                          std::vector<Index>& twin) {
  struct Side {
    Index polygon, from, to, halfedge;
    auto key() const { return std::tie(polygon, from, to); }
  };
  std::vector<Side> sides;
  for (Index f = 0; f < size_of(layers); ++f) {
    if (layers[f] >= 0) continue;
    const Index input = admitted.input_face[f];
    for (int k = 0; k < 3; ++k) {
      if (!polygons.is_diagonal(input, k)) continue;
      const auto [from, to] = std::minmax(faces[input][k], faces[input][next_corner(k)]);
      sides.push_back({polygons.polygon[input], from, to, 3 * f + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.polygon, a.from, a.to, a.halfedge) <
           std::tie(b.polygon, b.from, b.to, b.halfedge);
  });
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && sides[next].key() == sides[i].key()) ++next;
    if (next - i != 2) continue;
    twin[sides[i].halfedge] = sides[i + 1].halfedge;
    twin[sides[i + 1].halfedge] = sides[i].halfedge;
  }
}

/// Drops the copies.
void drop_copies(std::vector<Triangle>& faces, Layers& layers, Admitted& admitted) {
  Index kept = 0;
  for (Index f = 0; f < size_of(faces); ++f) {
    if (layers.is_copy[f]) continue;
    faces[kept] = faces[f];
    layers.of_face[kept] = layers.of_face[f];
    admitted.input_face[kept] = admitted.input_face[f];
    ++kept;
  }
  faces.resize(kept);
  admitted.input_face.resize(kept);
  layers.of_face.resize(kept);
}

void count_pieces(const Admitted& admitted, AdmitCounts& counts) {
  counts.reversed_faces =
      static_cast<Index>(std::count(admitted.reversed.begin(), admitted.reversed.end(), true));
  const std::vector<Index>& vertex = admitted.input_vertex;
  for (std::size_t i = 1; i < vertex.size(); ++i) {
    const bool second = vertex[i] == vertex[i - 1] && (i == 1 || vertex[i - 1] != vertex[i - 2]);
    counts.split_vertices += second ? 1 : 0;
  }
  counts.components = size_of(admitted.topology.components);
  for (const Component& component : admitted.topology.components) {
    counts.closed_components += component.loops == 0 ? 1 : 0;
    counts.holes += std::max(0, component.loops - 1);
  }
}

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

/// Marks per face of the input, in `apart`, the polygons whose faces on the surface form several
/// pieces. Returns whether there are any that had no mark.
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

/// Gives polygons that are apart, and of which a face has no area in space, the places of a regular
/// polygon with their area: any triangulation covers that once. What is no disk keeps its places.
void regularize(const PolygonParts& polygons, const Fate& fate, Admitted& admitted) {
  Surface& surface = admitted.surface;
  for_each_polygon(admitted, polygons, [&](Index begin, Index end) {
    if (!fate.apart[admitted.input_face[begin]]) return;
    double area = 0;
    bool is_bad = false;
    for (Index f = begin; f < end; ++f) {
      const auto [i, j, k] = surface.faces[f];
      area += triangle_area(surface.positions[i], surface.positions[j], surface.positions[k]);
      is_bad = is_bad || fate.without[admitted.input_face[f]];
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

/// The corners of the input's faces, before welding and after it.
struct Names {
  const std::vector<Triangle>&given, &welded;
};

/// All that follows welding, whose notes are in `admitted`.
Admitted admit_welded(const std::vector<Vec3>& positions, const Names& faces, const Fate& fate,
                      const AdmitOptions& options, Admitted admitted, const Work& work) {
  AdmitCounts& counts = admitted.counts;
  std::vector<Triangle> kept = faces_with_area(faces.given, faces.welded, fate, admitted);
  const std::vector<Index> firsts = firsts_of(size_of(positions), kept, work, admitted);
  std::vector<Index> polygons = polygons_of(admitted, options);
  Layers layers = layer_polygons(kept, polygons, firsts, fate, admitted);
  if (options.share_copies && counts.copies > 0) {
    drop_copies(kept, layers, admitted);
    polygons = polygons_of(admitted, options);
  }
  Gluing gluing = glue(positions, kept, layers.of_face, polygons, work);
  glue_folded_polygons(faces.given, options.polygons, admitted, layers.of_face, gluing.twin);
  counts.crowded_edges = gluing.crowded_edges;
  Orientation orientation = orient(kept, gluing.twin, polygons, work, &positions);
  counts.one_sided_edges = orientation.one_sided_edges;
  admitted.reversed = std::move(orientation.reversed);
  if (gluing.joined_in_crowds) part_double_edges(kept, gluing.twin);
  SplitSurface split = split_fans(positions, kept, gluing.twin, work);
  admitted.surface = std::move(split.surface);
  admitted.input_vertex = std::move(split.vertex);
  if (!polygons.empty()) {
    regularize(options.polygons, fate, admitted);
  }
  admitted.topology = topology_of(admitted.surface, work);
  count_pieces(admitted, counts);
  for (Index& v : admitted.input_vertex) v = admitted.welded(v);
  return admitted;
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

std::vector<bool> faces_without_area(const std::vector<Vec3>& positions,
                                     const std::vector<Triangle>& faces, const Work& work) {
  const std::vector<Size> sizes = sizes_of(positions, faces, work);
  double largest = 0;
  for (const Size& size : sizes) largest = std::max(largest, size.area);
  std::vector<bool> without(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    without[f] = !(sizes[f].area > kLeastArea * std::max(largest, sizes[f].longest_edge_sq));
  }
  return without;
}

Admitted admit(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
               const AdmitOptions& options, const Work& work) {
  validate_indices(size_of(positions), faces, RepeatedVertices::kAllowed, work);
  validate_positions(positions, work);
  Admitted start;
  start.counts.unused_vertices = unused_vertices(size_of(positions), faces);
  const std::vector<Triangle> named = welded(positions, faces, options, work, start);
  Fate fate{faces_without_area(positions, named, work), std::vector<bool>(faces.size(), false)};
  // Most files need one round. What parts in one may tear others, though none twice.
  for (;;) {
    Admitted admitted = admit_welded(positions, {faces, named}, fate, options, start, work);
    if (!mark_torn(admitted, options.polygons, fate.apart)) return admitted;
  }
}

}  // namespace beltrami
