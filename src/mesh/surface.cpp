#include "mesh/surface.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <string>
#include <utility>

#include "base/bucket_sort.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "mesh/edges.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

std::string quoted(Index index) {
  return std::to_string(index);
}

/// Throws NON_MANIFOLD_EDGE or ORIENTATION with the later face concerned, at the first edge with
/// more than two half-edges, or two in the same direction.
[[noreturn]] void throw_edge_defect(const std::vector<Triangle>& faces,
                                    const HalfedgeBuckets& buckets) {
  // For the larger end vertex: the half-edges seen in the current bucket, in each direction.
  struct Seen {
    Index bucket = kNone, up = kNone, down = kNone;
  };
  const Index vertex_count = size_of(buckets.start) - 1;
  std::vector<Seen> seen(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) {
    for (Index i = buckets.start[v]; i < buckets.start[v + 1]; ++i) {
      const Index h = buckets.spokes[i].halfedge();
      const auto [from, to] = ends_of(faces, h);
      Seen& other = seen[std::max(from, to)];
      if (other.bucket != v) other = {v, kNone, kNone};
      Index& same = from < to ? other.up : other.down;
      const Index opposite = from < to ? other.down : other.up;
      if (same == kNone) {
        same = h;
        continue;
      }
      const std::string edge = "the edge " + quoted(from) + "-" + quoted(to);
      if (opposite != kNone) {
        throw Error(Fault::kNonManifoldEdge,
                    "face " + quoted(h / 3) + " is at least the third on " + edge +
                        ": split the surface there, so that no edge has more than two faces",
                    Element::face(h / 3));
      }
      // A third face on the edge makes it non-manifold, whichever way it runs.
      const auto rest = buckets.spokes.begin() + i + 1;
      const auto end = buckets.spokes.begin() + buckets.start[v + 1];
      if (std::any_of(rest, end, [larger = std::max(from, to)](const Spoke& spoke) {
            return spoke.far() == larger;
          })) {
        throw Error(Fault::kNonManifoldEdge,
                    "more than two faces, " + quoted(h / 3) + " among them, share " + edge +
                        ": split the surface there",
                    Element::face(h / 3));
      }
      throw Error(Fault::kOrientation,
                  "faces " + quoted(same / 3) + " and " + quoted(h / 3) + " run along " + edge +
                      " in the same direction: orient all faces alike (or remove a duplicate)",
                  Element::face(h / 3));
    }
  }
  throw Error(Fault::kInternal, "half-edges could not be paired, please report it");
}

std::vector<Index> pair_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                                  const Work& work) {
  HalfedgeBuckets buckets = sort_halfedges(vertex_count, faces, work);
  std::vector<Index> twin;
  parallel_assign(work, twin, buckets.spokes.size(), kNone);
  std::atomic<bool> sound{true};
  for_each_edge(work, buckets, [&](std::span<const Spoke> edge) {
    if (edge.size() == 1) return;
    if (edge.size() > 2 || edge[0].outwards() == edge[1].outwards()) {
      sound = false;
      return;
    }
    twin[edge[0].halfedge()] = edge[1].halfedge();
    twin[edge[1].halfedge()] = edge[0].halfedge();
  });
  if (!sound) throw_edge_defect(faces, sort_halfedges(vertex_count, faces, work));
  return twin;
}

std::vector<Index> boundary_halfedges(const Surface& surface, const Work& work) {
  return parallel_filter(work, size_of(surface.twin), kGrain,
                         [&](Index h) { return surface.twin[h] == kNone; });
}

/// Fills `outgoing`, given the half-edges without a twin; throws NON_MANIFOLD_VERTEX where the
/// faces of a vertex form several fans.
void link_vertices(Surface& surface, const std::vector<Index>& boundary, const Work& work) {
  const Index vertex_count = surface.vertex_count();
  surface.outgoing.assign(vertex_count, kNone);
  // The first one, whichever thread comes first.
  parallel_for(work, surface.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for (int k = 0; k < 3; ++k) {
        const Index h = 3 * f + k;
        const std::atomic_ref<Index> outgoing(surface.outgoing[surface.faces[f][k]]);
        Index known = outgoing.load(std::memory_order_relaxed);
        while ((known == kNone || h < known) &&
               !outgoing.compare_exchange_weak(known, h, std::memory_order_relaxed)) {
        }
      }
    }
  });
  for (const Index h : boundary) surface.outgoing[surface.origin(h)] = h;

  const auto fan = [&](Index v) {
    Index faces = 0;
    if (surface.outgoing[v] == kNone) return faces;
    PollSometimes poll;  // a hub may have all faces
    surface.for_each_outgoing(v, [&](Index) {
      poll();
      ++faces;
    });
    return faces;
  };
  std::atomic<Index> in_fans{0};
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    Index faces = 0;
    for (auto v = static_cast<Index>(begin); v < end; ++v) faces += fan(v);
    in_fans += faces;
  });
  if (in_fans == size_of(surface.twin)) return;
  std::vector<Index> valence(vertex_count, 0);
  for (Index h = 0; h < size_of(surface.twin); ++h) ++valence[surface.origin(h)];
  Index v = 0;
  while (fan(v) == valence[v]) ++v;
  throw Error(Fault::kNonManifoldVertex,
              "the faces around vertex " + quoted(v) +
                  " form more than one fan: duplicate the vertex, one copy for each fan",
              Element::vertex(v));
}

}  // namespace

HalfedgeBuckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                               const Work& work) {
  HalfedgeBuckets buckets;
  const auto for_each_halfedge = [&](std::int64_t f, const auto& visit) {
    for (int k = 0; k < 3; ++k) {
      visit(static_cast<Index>(3 * f + k), faces[f][k], faces[f][next_corner(k)]);
    }
  };
  BucketSort<Index> sort(
      work, size_of(faces), vertex_count, buckets.start, [&](std::int64_t f, const auto& count) {
        for_each_halfedge(f, [&](Index, Index from, Index to) { count(std::min(from, to)); });
      });
  parallel_assign(work, buckets.spokes, 3 * faces.size());
  sort.place([&](std::int64_t f, const auto& place) {
    for_each_halfedge(f, [&](Index h, Index from, Index to) {
      buckets.spokes[place(std::min(from, to))] = Spoke(h, from, to);
    });
  });
  return buckets;
}

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
  DisjointSets sets(face_count);
  std::vector<std::vector<std::array<Index, 2>>> across((face_count + kGrain - 1) / kGrain);
  parallel_for(work, face_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      sets.make(f);
      for (int k = 0; k < 3; ++k) {
        const Index twin = surface.twin[3 * f + k];
        if (twin == kNone || twin / 3 > f) continue;
        if (twin / 3 >= begin) {
          sets.unite(f, twin / 3);
        } else {
          across[begin / kGrain].push_back({f, twin / 3});
        }
      }
    }
  });
  PollSometimes poll;
  for (const auto& pairs : across) {
    for (const auto& [one, other] : pairs) {
      poll();
      sets.unite(one, other);
    }
  }
  return std::move(sets).roots();
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

Surface build_surface(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work) {
  validate_indices(size_of(positions), faces, RepeatedVertices::kRefused, work);
  validate_positions(positions, work);
  Surface surface;
  surface.positions = std::move(positions);
  surface.faces = std::move(faces);
  surface.twin = pair_halfedges(surface.vertex_count(), surface.faces, work);
  const std::vector<Index> boundary = boundary_halfedges(surface, work);
  link_vertices(surface, boundary, work);
  surface.on_boundary.assign(surface.vertex_count(), false);
  for (const Index h : boundary) surface.on_boundary[surface.origin(h)] = true;
  return surface;
}

}  // namespace beltrami
