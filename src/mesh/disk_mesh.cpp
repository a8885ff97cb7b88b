#include "mesh/disk_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <string>

#include "base/bucket_sort.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
/// Of the exponent for the area, from a box of unit size: a surface that is nearly a line or a
/// point would grow until the fourth powers of its lengths leave the range of numbers.
constexpr int kMostGrowth = 40;

std::string quoted(Index index) {
  return std::to_string(index);
}

/// Half-edges by the smaller of their end vertices.
struct Buckets {
  std::vector<Index> start;     ///< per vertex, and one more
  std::vector<Index> halfedge;  ///< in increasing order in each bucket
};

std::array<Index, 2> ends_of(const std::vector<Triangle>& faces, Index h) {
  const Triangle& face = faces[h / 3];
  return {face[h % 3], face[next_corner(h % 3)]};
}

Buckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces, int threads) {
  Buckets buckets;
  const auto smaller_ends = [&](std::int64_t f, const auto& visit) {
    for (int k = 0; k < 3; ++k) visit(k, std::min(faces[f][k], faces[f][next_corner(k)]));
  };
  BucketSort<Index> sort(
      threads, size_of(faces), vertex_count, buckets.start,
      [&](std::int64_t f, const auto& count) { smaller_ends(f, [&](int, Index v) { count(v); }); });
  parallel_assign(threads, buckets.halfedge, 3 * faces.size());
  sort.place([&](std::int64_t f, const auto& place) {
    smaller_ends(
        f, [&](int k, Index v) { buckets.halfedge[place(v)] = static_cast<Index>(3 * f + k); });
  });
  return buckets;
}

/// A half-edge seen from its smaller end.
struct Spoke {
  Index far, halfedge;
  bool outwards;

  bool operator<(const Spoke& other) const { return far < other.far; }
};

/// False if more than two half-edges run along an edge, or two in the same direction.
bool pair_spokes(std::vector<Spoke>& spokes, std::vector<Index>& twin) {
  sort_interruptibly(spokes.begin(), spokes.end(), std::less<>());
  for (std::size_t i = 0; i + 1 < spokes.size(); ++i) {
    const Spoke &one = spokes[i], &other = spokes[i + 1];
    if (one.far != other.far) continue;
    if (one.outwards == other.outwards || twin[one.halfedge] != kNone) return false;
    twin[one.halfedge] = other.halfedge;
    twin[other.halfedge] = one.halfedge;
  }
  return true;
}

/// Throws NON_MANIFOLD_EDGE or ORIENTATION with the later face concerned, at the first edge that
/// pair_spokes refuses.
[[noreturn]] void throw_edge_defect(const std::vector<Triangle>& faces, const Buckets& buckets) {
  // For the larger end vertex: the half-edges seen in the current bucket, in each direction.
  struct Seen {
    Index bucket = kNone, up = kNone, down = kNone;
  };
  const Index vertex_count = size_of(buckets.start) - 1;
  std::vector<Seen> seen(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) {
    for (Index i = buckets.start[v]; i < buckets.start[v + 1]; ++i) {
      const Index h = buckets.halfedge[i];
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
        throw Error(BELTRAMI_E_NON_MANIFOLD_EDGE,
                    "face " + quoted(h / 3) + " is at least the third on " + edge +
                        ": split the surface there, so that no edge has more than two faces",
                    Element::face(h / 3));
      }
      // A third face on the edge makes it non-manifold, whichever way it runs.
      const auto rest = buckets.halfedge.begin() + i + 1;
      const auto end = buckets.halfedge.begin() + buckets.start[v + 1];
      if (std::any_of(rest, end, [&, larger = std::max(from, to)](Index g) {
            const auto [a, b] = ends_of(faces, g);
            return std::max(a, b) == larger;
          })) {
        throw Error(BELTRAMI_E_NON_MANIFOLD_EDGE,
                    "more than two faces, " + quoted(h / 3) + " among them, share " + edge +
                        ": split the surface there",
                    Element::face(h / 3));
      }
      throw Error(BELTRAMI_E_ORIENTATION,
                  "faces " + quoted(same / 3) + " and " + quoted(h / 3) + " run along " + edge +
                      " in the same direction: orient all faces alike (or remove a duplicate)",
                  Element::face(h / 3));
    }
  }
  throw Error(BELTRAMI_E_INTERNAL, "half-edges could not be paired, please report it");
}

/// Pairs half-edges: no hash map, no sort over the whole.
std::vector<Index> pair_halfedges(Index vertex_count, const std::vector<Triangle>& faces,
                                  int threads) {
  const Buckets buckets = sort_halfedges(vertex_count, faces, threads);
  std::vector<Index> twin;
  parallel_assign(threads, twin, buckets.halfedge.size(), kNone);
  std::atomic<bool> sound{true};
  parallel_for(threads, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Spoke> spokes;
    for (std::int64_t v = begin; v < end; ++v) {
      spokes.clear();
      for (Index i = buckets.start[v]; i < buckets.start[v + 1]; ++i) {
        const Index h = buckets.halfedge[i];
        const auto [from, to] = ends_of(faces, h);
        spokes.push_back({std::max(from, to), h, from < to});
      }
      if (!pair_spokes(spokes, twin)) sound = false;
    }
  });
  if (!sound) throw_edge_defect(faces, buckets);
  return twin;
}

/// Fills `outgoing`, given the half-edges without a twin; throws NON_MANIFOLD_VERTEX where the
/// faces of a vertex form several fans.
void link_vertices(DiskMesh& mesh, const std::vector<Index>& boundary, int threads) {
  const Index vertex_count = mesh.vertex_count();
  mesh.outgoing.assign(vertex_count, kNone);
  // The first one, whichever thread comes first.
  parallel_for(threads, size_of(mesh.twin), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<Index>(begin); h < end; ++h) {
      const std::atomic_ref<Index> outgoing(mesh.outgoing[mesh.origin(h)]);
      Index known = outgoing.load(std::memory_order_relaxed);
      while ((known == kNone || h < known) &&
             !outgoing.compare_exchange_weak(known, h, std::memory_order_relaxed)) {
      }
    }
  });
  for (const Index h : boundary) mesh.outgoing[mesh.origin(h)] = h;

  const auto fan = [&](Index v) {
    Index faces = 0;
    if (mesh.outgoing[v] == kNone) return faces;
    PollSometimes poll;  // a hub may have all faces
    mesh.for_each_outgoing(v, [&](Index) {
      poll();
      ++faces;
    });
    return faces;
  };
  std::atomic<Index> in_fans{0};
  parallel_for(threads, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    Index faces = 0;
    for (auto v = static_cast<Index>(begin); v < end; ++v) faces += fan(v);
    in_fans += faces;
  });
  if (in_fans == size_of(mesh.twin)) return;
  std::vector<Index> valence(vertex_count, 0);
  for (Index h = 0; h < size_of(mesh.twin); ++h) ++valence[mesh.origin(h)];
  Index v = 0;
  while (fan(v) == valence[v]) ++v;
  throw Error(BELTRAMI_E_NON_MANIFOLD_VERTEX,
              "the faces around vertex " + quoted(v) +
                  " form more than one fan: duplicate the vertex, one copy for each fan",
              Element::vertex(v));
}

/// Sets of connected faces as trees (Tarjan 1975); the least face of each is its root.
class Components {
 public:
  explicit Components(Index count) : parent_(count) {}

  void make(Index face) { parent_[face] = face; }
  Index root(Index face) {
    while (parent_[face] != face) face = parent_[face] = parent_[parent_[face]];
    return face;
  }
  void unite(Index one, Index other) {
    one = root(one);
    other = root(other);
    parent_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<Index> parent_;
};

/// Chunks of faces side by side, then what connects them.
void require_one_component(const DiskMesh& mesh, int threads) {
  Components components(mesh.face_count());
  std::vector<std::vector<std::array<Index, 2>>> across((mesh.face_count() + kGrain - 1) / kGrain);
  parallel_for(threads, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      components.make(f);
      for (int k = 0; k < 3; ++k) {
        const Index twin = mesh.twin[3 * f + k];
        if (twin == kNone || twin / 3 > f) continue;
        if (twin / 3 >= begin) {
          components.unite(f, twin / 3);
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
      components.unite(one, other);
    }
  }
  // Each other component shows at its least face, its root.
  Index outside = 1;
  while (outside < mesh.face_count() && components.root(outside) == 0) {
    poll();
    ++outside;
  }
  if (outside == mesh.face_count()) return;
  throw Error(
      BELTRAMI_E_COMPONENTS,
      "face " + quoted(outside) + " is not connected to face 0: flatten each component on its own",
      Element::face(outside));
}

/// Walks the boundary; throws CLOSED, BOUNDARIES or GENUS.
void trace_boundary(DiskMesh& mesh, const std::vector<Index>& halfedges) {
  mesh.on_boundary.assign(mesh.vertex_count(), false);
  for (const Index h : halfedges) mesh.on_boundary[mesh.origin(h)] = true;
  const Index boundary_edges = size_of(halfedges);
  if (halfedges.empty()) {
    throw Error(BELTRAMI_E_CLOSED,
                "the surface is closed, it has no boundary: cut it open along a seam first");
  }
  std::vector<bool> visited(mesh.vertex_count(), false);
  Index v = mesh.origin(halfedges.front());
  PollSometimes poll;
  do {
    poll();
    mesh.boundary.push_back(v);
    visited[v] = true;
    v = mesh.target(mesh.outgoing[v]);
  } while (v != mesh.boundary.front());

  if (size_of(mesh.boundary) != boundary_edges) {
    Index other = 0;
    while (!mesh.on_boundary[other] || visited[other]) ++other;
    throw Error(
        BELTRAMI_E_BOUNDARIES,
        "vertex " + quoted(other) +
            " lies on a second boundary loop: fill the hole, or cut from it to the boundary",
        Element::vertex(other));
  }
  const std::int64_t edges = (std::int64_t{3} * mesh.face_count() + boundary_edges) / 2;
  const std::int64_t euler = mesh.vertex_count() - edges + mesh.face_count();
  if (euler != 1) {
    throw Error(BELTRAMI_E_GENUS, "the surface has " + std::to_string((1 - euler) / 2) +
                                      " handle(s), genus above 0: cut them open first");
  }
}

double total_area(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                  int threads) {
  return parallel_sum(threads, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    double area = 0;
    for (std::int64_t f = begin; f < end; ++f) {
      area += triangle_area(positions[faces[f][0]], positions[faces[f][1]], positions[faces[f][2]]);
    }
    return area;
  });
}

}  // namespace

void validate_indices(Index vertex_count, const std::vector<Triangle>& faces, int threads) {
  if (vertex_count == 0 || faces.empty()) {
    throw Error(BELTRAMI_E_EMPTY, "the mesh has no vertices or no faces: there is nothing to do");
  }
  const auto in_range = [&](Index v) { return v >= 0 && v < vertex_count; };
  const auto defect = parallel_find(threads, size_of(faces), kGrain, [&](std::int64_t f) {
    const auto [a, b, c] = faces[f];
    return !in_range(a) || !in_range(b) || !in_range(c) || a == b || b == c || c == a;
  });
  if (defect == size_of(faces)) return;
  const auto f = static_cast<Index>(defect);
  for (const Index v : faces[f]) {
    if (in_range(v)) continue;
    throw Error(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                "face " + quoted(f) + " names vertex " + quoted(v) + " of " + quoted(vertex_count) +
                    ": indices count from 0",
                Element::face(f));
  }
  throw Error(BELTRAMI_E_REPEATED_VERTEX,
              "face " + quoted(f) + " names one vertex twice: remove the face", Element::face(f));
}

void validate_positions(const std::vector<Vec3>& positions, int threads) {
  const auto defect = parallel_find(threads, size_of(positions), kGrain,
                                    [&](std::int64_t v) { return !positions[v].allFinite(); });
  if (defect == size_of(positions)) return;
  const auto v = static_cast<Index>(defect);
  throw Error(BELTRAMI_E_NON_FINITE,
              "vertex " + quoted(v) + " has a coordinate that is infinite or not a number",
              Element::vertex(v));
}

std::vector<Index> drop_unreferenced(Index vertex_count, std::vector<Triangle>& faces,
                                     int threads) {
  std::vector<Index> renumbered(vertex_count, kNone);
  parallel_for(threads, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (const Index v : faces[f]) {
        std::atomic_ref<Index>(renumbered[v]).store(0, std::memory_order_relaxed);
      }
    }
  });
  std::vector<Index> original;
  original.reserve(vertex_count);
  PollSometimes poll;
  for (Index v = 0; v < vertex_count; ++v) {
    poll();
    if (renumbered[v] == kNone) continue;
    renumbered[v] = size_of(original);
    original.push_back(v);
  }
  if (size_of(original) == vertex_count) return original;
  parallel_for(threads, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (Index& v : faces[f]) v = renumbered[v];
    }
  });
  return original;
}

DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces, int threads) {
  validate_indices(size_of(positions), faces, threads);
  validate_positions(positions, threads);
  DiskMesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  mesh.twin = pair_halfedges(mesh.vertex_count(), mesh.faces, threads);
  const std::vector<Index> boundary = parallel_filter(
      threads, size_of(mesh.twin), kGrain, [&](Index h) { return mesh.twin[h] == kNone; });
  link_vertices(mesh, boundary, threads);
  require_one_component(mesh, threads);
  trace_boundary(mesh, boundary);
  return mesh;
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

double surface_area(const DiskMesh& mesh, int threads) {
  return total_area(mesh.positions, mesh.faces, threads);
}

Normalisation normalise(std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        int threads) {
  Vec3 low = positions.front(), high = positions.front();
  PollSometimes poll;
  for (const Vec3& p : positions) {
    poll();
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Normalisation frame;
  frame.centre = 0.5 * low + 0.5 * high;
  // The extent first, so that the area of a mesh of any unit neither under- nor overflows.
  const double extent = (0.5 * high - 0.5 * low).maxCoeff();
  if (!(extent > 0)) {
    throw Error(BELTRAMI_E_ZERO_AREA, "all vertices coincide: the surface has no area");
  }
  const auto for_each_position = [&](const auto& change) {
    parallel_for(threads, size_of(positions), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v) change(positions[v]);
    });
  };
  const auto rescale = [&](int exponent) {
    frame.exponent += exponent;
    // Two factors, since one alone could leave the range of numbers that their product stays in.
    const double half = std::ldexp(1.0, exponent / 2),
                 rest = std::ldexp(1.0, exponent - exponent / 2);
    for_each_position([=](Vec3& p) { p = p * half * rest; });
  };
  for_each_position([&](Vec3& p) { p -= frame.centre; });
  rescale(-std::ilogb(extent));
  const double area = total_area(positions, faces, threads);
  if (!(area > 0)) {
    throw Error(BELTRAMI_E_ZERO_AREA,
                "the surface has no area: every face is degenerate (check the vertex positions)");
  }
  // Nearest power of two to 1/sqrt(area).
  rescale(std::min(kMostGrowth, -((std::ilogb(area) + 1) >> 1)));
  return frame;
}

}  // namespace beltrami
