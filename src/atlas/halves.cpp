#include "atlas/halves.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "atlas/congruent.h"
#include "atlas/open.h"
#include "base/interrupt.h"
#include "base/vectors.h"
#include "cut/given.h"
#include "cut/mirror.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// Of the root of the area: how far a vertex may be from where its partner is mirrored to, as
/// congruent pieces may be.
constexpr double kSamePlace = 1e-4;

/// The mirror as the faces of a surface have it.
class Halves {
 public:
  Halves(const Surface& surface, const Mirror& mirror, double tolerance)
      : surface_(surface), mirror_(mirror), tolerance_(tolerance) {}

  /// 1 or -1 for a face on a side of the plane; 0 for one that is on both, or has a vertex without
  /// a partner.
  int side(Index face) const {
    int side = 0;
    for (const Index v : surface_.faces[face]) {
      if (!has_partner(v)) return 0;
      if (mirror_.side[v] == 0) continue;
      if (side != 0 && side != mirror_.side[v]) return 0;
      side = mirror_.side[v];
    }
    return side;
  }

 private:
  bool has_partner(Index v) const {
    const Index other = mirror_.side[v] == 0 ? v : mirror_.image[v];
    if (other == kNone) return false;
    if (other != v && (mirror_.image[other] != v || mirror_.side[other] == mirror_.side[v])) {
      return false;
    }
    const Vec3& p = surface_.positions[v];
    const Vec3 mirrored = p - 2 * mirror_.normal.dot(p - mirror_.point) * mirror_.normal;
    return (surface_.positions[other] - mirrored).norm() <= tolerance_;
  }

  const Surface& surface_;
  const Mirror& mirror_;
  double tolerance_;
};

/// Per face, a number of its component.
std::vector<Index> components(const Surface& surface) {
  std::vector<Index> component(surface.faces.size(), kNone);
  std::vector<Index> faces;
  PollSometimes poll;
  for (Index first = 0; first < surface.face_count(); ++first) {
    if (component[first] != kNone) continue;
    component[first] = first;
    faces.push_back(first);
    while (!faces.empty()) {
      poll();
      const Index f = faces.back();
      faces.pop_back();
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index twin = surface.twin[h];
        if (twin == kNone || component[twin / 3] != kNone) continue;
        component[twin / 3] = first;
        faces.push_back(twin / 3);
      }
    }
  }
  return component;
}

/// An edge where its component is to be parted, as half-edge.
struct Parting {
  Index half_edge, component;
};

std::vector<Parting> partings(const Surface& surface, const std::vector<Index>& component,
                              const Work& work) {
  const std::optional<Mirror> mirror = find_mirror(surface, kSamePlace, work);
  if (!mirror) return {};
  const Halves halves(surface, *mirror, kSamePlace * std::sqrt(surface_area(surface, work)));
  std::vector<std::int8_t> side(surface.faces.size());
  std::vector<bool> parts(surface.faces.size(), true);  // of the numbers of components
  PollSometimes poll;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    side[f] = static_cast<std::int8_t>(halves.side(f));
    if (side[f] == 0) parts[component[f]] = false;
  }
  std::vector<Parting> found;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    const Index twin = surface.twin[h];
    if (twin < h || twin == kNone || side[h / 3] == side[twin / 3]) continue;
    if (parts[component[h / 3]]) found.push_back({h, component[h / 3]});
  }
  return found;
}

/// Per number of a component whether each of its pieces has the shape of another one of them.
std::vector<bool> is_halved(const std::vector<SurfacePiece>& pieces,
                            const std::vector<Index>& component) {
  const std::vector<Index> first = first_congruent(pieces);
  // The component and the first of its kind, per piece.
  std::map<std::pair<Index, Index>, Index> alike;
  const auto kind = [&](Index p) { return std::pair(component[pieces[p].face.front()], first[p]); };
  for (Index p = 0; p < size_of(pieces); ++p) ++alike[kind(p)];
  std::vector<bool> halved(component.size(), true);
  for (Index p = 0; p < size_of(pieces); ++p) {
    if (alike[kind(p)] < 2) halved[kind(p).first] = false;
  }
  return halved;
}

}  // namespace

std::vector<std::array<Index, 2>> edges_between_halves(const AtlasInput& input,
                                                       const Admitted& admitted,
                                                       const AtlasOptions& options,
                                                       const Work& work) {
  const Surface& surface = admitted.surface;
  const std::vector<Index> component = components(surface);
  std::vector<Parting> found = partings(surface, component, work);
  const auto edges_of = [&] {
    std::vector<std::array<Index, 2>> edges;
    for (const Parting& parting : found) {
      edges.push_back({admitted.input_vertex[surface.origin(parting.half_edge)],
                       admitted.input_vertex[surface.target(parting.half_edge)]});
    }
    return edges;
  };
  if (found.empty()) return {};
  // Whether halves are alike is seen once they are apart.
  GivenCuts cuts = input.cuts;
  const std::vector<std::array<Index, 2>> edges = edges_of();
  cuts.edges.insert(cuts.edges.end(), edges.begin(), edges.end());
  ReadySurface ready =
      make_ready(admitted, cuts, options.fill_limit, options.admit.polygons, input.hints, work);
  const std::vector<bool> halved =
      is_halved(components_of(std::move(ready.whole), work), component);
  std::erase_if(found, [&](const Parting& parting) { return !halved[parting.component]; });
  return edges_of();
}

}  // namespace beltrami
