#include "mesh/surface.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/twins.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;

std::string quoted(Index index) {
  return std::to_string(index);
}

/// Fills `outgoing`, given the half-edges without a twin.
void link_vertices(Surface& surface, const std::vector<Index>& boundary, const Work& work) {
  parallel_assign(work, surface.outgoing, surface.positions.size(), kNone);
  // The least, whichever thread comes first; as an unsigned number, kNone is the greatest.
  const auto lower = [](Index& least, Index halfedge) {
    const std::atomic_ref<Index> shared(least);
    Index before = shared.load(std::memory_order_relaxed);
    while (static_cast<std::uint32_t>(halfedge) < static_cast<std::uint32_t>(before)) {
      if (shared.compare_exchange_weak(before, halfedge, std::memory_order_relaxed)) return;
    }
  };
  parallel_for(work, surface.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for (int k = 0; k < 3; ++k) lower(surface.outgoing[surface.faces[f][k]], 3 * f + k);
    }
  });
  for (const Index h : boundary) surface.outgoing[surface.origin(h)] = h;
}

/// How many faces the fan of a vertex has that its `outgoing` belongs to.
Index faces_in_fan(const Surface& surface, Index v) {
  if (surface.outgoing[v] == kNone) return 0;
  Index faces = 0;
  PollSometimes poll;  // a hub may have all faces
  surface.for_each_outgoing(v, [&](Index) {
    poll();
    ++faces;
  });
  return faces;
}

/// The half-edges without a twin, increasing.
std::vector<Index> boundary_halfedges(const Surface& surface, const Work& work) {
  std::vector<Index> halfedges = parallel_filter(
      work, surface.vertex_count(), kGrain,
      [&](Index v) { return surface.on_boundary[v] && surface.outgoing[v] != kNone; });
  for (Index& item : halfedges) item = surface.outgoing[item];
  sort_interruptibly(halfedges.begin(), halfedges.end(), std::less<>());
  return halfedges;
}

}  // namespace

void validate_indices(Index vertex_count, const std::vector<Triangle>& faces,
                      RepeatedVertices repeated, const Work& work) {
  if (vertex_count == 0 || faces.empty()) {
    throw Error(Fault::kEmpty, "the mesh has no vertices or no faces: there is nothing to do");
  }
  const auto in_range = [&](Index v) { return v >= 0 && v < vertex_count; };
  const auto defect = parallel_find(work, size_of(faces), kGrain, [&](std::int64_t f) {
    const auto [a, b, c] = faces[f];
    if (!in_range(a) || !in_range(b) || !in_range(c)) return true;
    return repeated == RepeatedVertices::kRefused && (a == b || b == c || c == a);
  });
  if (defect == size_of(faces)) return;
  const auto f = static_cast<Index>(defect);
  for (const Index v : faces[f]) {
    if (in_range(v)) continue;
    throw Error(Fault::kIndexOutOfRange,
                "face " + quoted(f) + " names vertex " + quoted(v) + " of " + quoted(vertex_count) +
                    ": indices count from 0",
                Element::face(f));
  }
  throw Error(Fault::kRepeatedVertex,
              "face " + quoted(f) + " names one vertex twice: remove the face", Element::face(f));
}

void validate_positions(const std::vector<Vec3>& positions, const Work& work) {
  const auto defect = parallel_find(work, size_of(positions), kGrain,
                                    [&](std::int64_t v) { return !positions[v].allFinite(); });
  if (defect == size_of(positions)) return;
  const auto v = static_cast<Index>(defect);
  throw Error(Fault::kNonFinite,
              "vertex " + quoted(v) + " has a coordinate that is infinite or not a number",
              Element::vertex(v));
}

std::vector<Index> connected_faces(const Surface& surface, const Work& work) {
  // Chunks of faces side by side, then what connects them.
  const Index face_count = surface.face_count();
  DisjointSets sets(face_count, work);
  std::vector<std::vector<std::array<Index, 2>>> across((face_count + kGrain - 1) / kGrain);
  parallel_for(work, face_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    const auto first = static_cast<Index>(3 * begin);
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index* const twin = &surface.twin[3 * f];
      const auto is_before = [&](Index t) { return t >= first && t < 3 * f; };
      // Most have the set of whichever neighbour before them is looked at.
      Index known = f;
      for (int k = 0; k < 3; ++k) known = is_before(twin[k]) ? twin[k] / 3 : known;
      sets.make(f, known == f ? f : sets.root(known));
      for (int k = 0; k < 3; ++k) {
        const Index other = is_before(twin[k]) ? twin[k] / 3 : known;
        if (!sets.have_one_parent(f, other)) sets.unite(f, other);
        if (twin[k] != kNone && twin[k] < first) across[begin / kGrain].push_back({f, twin[k] / 3});
      }
    }
  });
  parallel_for(work, size_of(across), 1, [&](std::int64_t chunk, std::int64_t) {
    PollSometimes poll;
    for (const auto& [one, other] : across[chunk]) {
      poll();
      sets.unite_beside_others(one, other);
    }
  });
  return std::move(sets).roots(work);
}

BoundaryLoops boundary_loops(const Surface& surface, const Work& work) {
  BoundaryLoops loops;
  const std::vector<Index> halfedges = boundary_halfedges(surface, work);
  loops.halfedge.reserve(halfedges.size());
  std::vector<bool> visited(halfedges.empty() ? 0 : surface.vertex_count(), false);
  PollSometimes poll;
  for (const Index first : halfedges) {
    if (visited[surface.origin(first)]) continue;
    loops.start.push_back(size_of(loops.halfedge));
    Index h = first;
    do {
      poll();
      visited[surface.origin(h)] = true;
      loops.halfedge.push_back(h);
      h = surface.outgoing[surface.target(h)];
    } while (h != first);
  }
  loops.start.push_back(size_of(loops.halfedge));
  return loops;
}

std::int64_t edge_count(std::int64_t faces, std::int64_t boundary_edges) {
  return (3 * faces + boundary_edges) / 2;
}

Topology topology_of(const Surface& surface, const Work& work) {
  Topology topology;
  topology.component_of_face = connected_faces(surface, work);
  topology.loops = boundary_loops(surface, work);
  PollSometimes poll;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    // The least face of a component comes first, so the number of its component is known.
    Index& component = topology.component_of_face[f];
    if (component == f) {
      component = size_of(topology.components);
      topology.components.emplace_back().first_face = f;
    } else {
      component = topology.component_of_face[component];
    }
    ++topology.components[component].faces;
  }
  for (const Index h : surface.outgoing) {
    poll();
    if (h != kNone) ++topology.components[topology.component_of_face[h / 3]].vertices;
  }
  const BoundaryLoops& loops = topology.loops;
  for (Index loop = 0; loop < loops.count(); ++loop) {
    const Index first = loops.start[loop];
    const Index component = topology.component_of_face[loops.halfedge[first] / 3];
    topology.component_of_loop.push_back(component);
    ++topology.components[component].loops;
    topology.components[component].boundary_edges += loops.start[loop + 1] - first;
  }
  return topology;
}

Surface connect_faces(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work) {
  validate_indices(size_of(positions), faces, RepeatedVertices::kRefused, work);
  validate_positions(positions, work);
  Surface surface;
  surface.positions = std::move(positions);
  surface.faces = std::move(faces);
  surface.twin = pair_halfedges(surface.vertex_count(), surface.faces, work);
  const std::vector<Index> boundary = parallel_filter(
      work, size_of(surface.twin), kGrain, [&](Index h) { return surface.twin[h] == kNone; });
  surface.on_boundary.assign(surface.vertex_count(), false);
  for (const Index h : boundary) surface.on_boundary[surface.origin(h)] = true;
  link_vertices(surface, boundary, work);
  return surface;
}

void prove_fans(const Surface& surface, const Work& work) {
  const Index vertex_count = surface.vertex_count();
  std::atomic<Index> in_fans{0};
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    Index faces = 0;
    for (auto v = static_cast<Index>(begin); v < end; ++v) faces += faces_in_fan(surface, v);
    in_fans += faces;
  });
  if (in_fans == size_of(surface.twin)) return;
  std::vector<Index> valence(vertex_count, 0);
  for (Index h = 0; h < size_of(surface.twin); ++h) ++valence[surface.origin(h)];
  Index v = 0;
  while (faces_in_fan(surface, v) == valence[v]) ++v;
  throw Error(Fault::kNonManifoldVertex,
              "the faces around vertex " + quoted(v) +
                  " form more than one fan: duplicate the vertex, one copy for each fan",
              Element::vertex(v));
}

Surface build_surface(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work) {
  Surface surface = connect_faces(std::move(positions), std::move(faces), work);
  prove_fans(surface, work);
  return surface;
}

}  // namespace beltrami
