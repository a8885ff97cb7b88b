#include "session/ground.h"

#include <algorithm>

#include "admit/arrange_admitted.h"
#include "atlas/open.h"
#include "base/interrupt.h"
#include "base/vectors.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

EdgeMarks edges_inside(const Admitted& admitted, const GroundOptions& options) {
  const Surface& surface = admitted.surface;
  const PolygonParts& polygons = options.admit.polygons;
  if (polygons.polygon.empty()) return {};
  EdgeMarks inside(surface.twin.size(), false);
  for (Index h = 0; h < size_of(surface.twin); ++h) {
    const Index twin = surface.twin[h];
    if (twin != kNone && is_inside_polygon(admitted, polygons, h, twin)) inside[h] = true;
  }
  return inside;
}

}  // namespace

std::vector<Index> Ground::halfedges_between(Index a, Index b) const {
  const Index from = admitted.welded(a), to = admitted.welded(b);
  const std::pair<std::array<Index, 2>, Index> first{{std::min(from, to), std::max(from, to)}, 0};
  std::vector<Index> found;
  for (auto at = std::lower_bound(edges.begin(), edges.end(), first);
       at != edges.end() && at->first == first.first; ++at) {
    found.push_back(at->second);
  }
  return found;
}

Index Ground::own_corner(Index input_face, int corner) const {
  const Index face = face_of[input_face];
  if (face == kNone) return kNone;
  for (int k = 0; k < 3; ++k) {
    if (admitted.input_corner(face, k) == corner) return 3 * face + k;
  }
  return kNone;
}

Ground make_ground(const std::vector<Vec3>& positions, std::vector<Triangle> faces,
                   const GroundOptions& options, const Work& work) {
  Ground ground;
  ground.admitted = admit(positions, faces, options.admit, work);
  Admitted& admitted = ground.admitted;
  // Every update goes over its charts many times, and takes half the time where neighbours lie
  // close.
  arrange_admitted(admitted, work);
  ground.exponent = bring_to_unit(admitted.surface, work);
  ground.inside = edges_inside(admitted, options);
  ground.fill_limit = options.fill_limit;
  const auto& polygons = options.admit.polygons.polygon;
  ground.polygon_of.assign(polygons.begin(), polygons.end());
  ground.face_of.assign(faces.size(), kNone);
  for (Index f = 0; f < ground.face_count(); ++f) ground.face_of[admitted.input_face[f]] = f;
  for (Index h = 0; h < size_of(admitted.surface.twin); ++h) {
    const Index a = admitted.input_vertex[admitted.surface.origin(h)];
    const Index b = admitted.input_vertex[admitted.surface.target(h)];
    ground.edges.push_back({{std::min(a, b), std::max(a, b)}, h});
  }
  sort_interruptibly(ground.edges.begin(), ground.edges.end(), std::less<>());
  ground.input_faces = std::move(faces);
  return ground;
}

}  // namespace beltrami
