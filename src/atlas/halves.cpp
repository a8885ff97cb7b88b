#include "atlas/halves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/interrupt.h"
#include "base/vectors.h"
#include "cut/mirror.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// Of the root of the area: how far a vertex may be from where its partner is mirrored to, as
/// congruent pieces may be.
constexpr double kSamePlace = 1e-4;

/// Corners of faces, in ascending order.
std::vector<Triangle> sorted_faces(const Surface& surface) {
  std::vector<Triangle> faces = surface.faces;
  for (Triangle& face : faces) std::sort(face.begin(), face.end());
  sort_interruptibly(faces.begin(), faces.end(), std::less<>());
  return faces;
}

/// The mirror as the faces of a surface have it.
class Halves {
 public:
  Halves(const Surface& surface, const Mirror& mirror, double tolerance)
      : surface_(surface), mirror_(mirror), tolerance_(tolerance), faces_(sorted_faces(surface)) {}

  /// 1 or -1 for a face on a side of the plane; 0 for one that is on both, or is mirrored to no
  /// face.
  int side(Index face) const {
    int side = 0;
    Triangle image = surface_.faces[face];
    for (Index& v : image) {
      if (!has_partner(v)) return 0;
      v = partner(v);
    }
    std::sort(image.begin(), image.end());
    if (!std::binary_search(faces_.begin(), faces_.end(), image)) return 0;
    for (const Index v : surface_.faces[face]) {
      if (mirror_.side[v] == 0) continue;
      if (side != 0 && side != mirror_.side[v]) return 0;
      side = mirror_.side[v];
    }
    return side;
  }

 private:
  Index partner(Index v) const { return mirror_.side[v] == 0 ? v : mirror_.image[v]; }

  bool has_partner(Index v) const {
    const Index other = partner(v);
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
  std::vector<Triangle> faces_;
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

}  // namespace

std::vector<std::array<Index, 2>> edges_between_halves(const Admitted& admitted, const Work& work) {
  const Surface& surface = admitted.surface;
  const std::optional<Mirror> mirror = find_mirror(surface, kSamePlace, work);
  if (!mirror) return {};
  const double tolerance = kSamePlace * std::sqrt(surface_area(surface, work));
  const Halves halves(surface, *mirror, tolerance);
  const std::vector<Index> component = components(surface);
  std::vector<std::int8_t> side(surface.faces.size());
  std::vector<bool> parts(surface.faces.size(), true);  // of the numbers of components
  PollSometimes poll;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    side[f] = static_cast<std::int8_t>(halves.side(f));
    if (side[f] == 0) parts[component[f]] = false;
  }
  std::vector<std::array<Index, 2>> edges;
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    poll();
    const Index twin = surface.twin[h];
    if (twin < h || twin == kNone || side[h / 3] == side[twin / 3]) continue;
    if (!parts[component[h / 3]]) continue;
    edges.push_back(
        {admitted.input_vertex[surface.origin(h)], admitted.input_vertex[surface.target(h)]});
  }
  return edges;
}

}  // namespace beltrami
