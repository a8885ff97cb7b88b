#include "mesh/disk_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

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

Buckets sort_halfedges(Index vertex_count, const std::vector<Triangle>& faces) {
  Buckets buckets;
  const Index halfedge_count = 3 * size_of(faces);
  const auto smaller_end = [&](Index h) {
    const auto [from, to] = ends_of(faces, h);
    return std::min(from, to);
  };
  buckets.start.assign(vertex_count + 1, 0);
  for (Index h = 0; h < halfedge_count; ++h) ++buckets.start[smaller_end(h) + 1];
  for (Index v = 0; v < vertex_count; ++v) buckets.start[v + 1] += buckets.start[v];
  buckets.halfedge.resize(halfedge_count);
  std::vector<Index> cursor(buckets.start.begin(), buckets.start.end() - 1);
  for (Index h = 0; h < halfedge_count; ++h) buckets.halfedge[cursor[smaller_end(h)]++] = h;
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
  std::sort(spokes.begin(), spokes.end());
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
  const Buckets buckets = sort_halfedges(vertex_count, faces);
  std::vector<Index> twin(buckets.halfedge.size(), kNone);
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

/// Fills `outgoing`; throws NON_MANIFOLD_VERTEX where the faces of a vertex form several fans.
void link_vertices(DiskMesh& mesh, int threads) {
  const Index vertex_count = mesh.vertex_count();
  mesh.outgoing.assign(vertex_count, kNone);
  std::vector<Index> valence(vertex_count, 0);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index v = mesh.origin(h);
    ++valence[v];
    if (mesh.outgoing[v] == kNone || mesh.twin[h] == kNone) mesh.outgoing[v] = h;
  }
  std::atomic<Index> first_defect{vertex_count};
  parallel_for(threads, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (mesh.outgoing[v] == kNone) continue;
      Index fan = 0;
      mesh.for_each_outgoing(v, [&](Index) { ++fan; });
      if (fan == valence[v]) continue;
      Index known = first_defect;
      while (v < known && !first_defect.compare_exchange_weak(known, v)) {
      }
      return;
    }
  });
  if (const Index v = first_defect; v < vertex_count) {
    throw Error(BELTRAMI_E_NON_MANIFOLD_VERTEX,
                "the faces around vertex " + quoted(v) +
                    " form more than one fan: duplicate the vertex, one copy for each fan",
                Element::vertex(v));
  }
}

void require_one_component(const DiskMesh& mesh) {
  std::vector<bool> reached(mesh.face_count(), false);
  std::vector<Index> stack{0};
  reached[0] = true;
  while (!stack.empty()) {
    const Index face = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Index twin = mesh.twin[3 * face + k];
      if (twin != kNone && !reached[twin / 3]) {
        reached[twin / 3] = true;
        stack.push_back(twin / 3);
      }
    }
  }
  const auto outside = std::find(reached.begin(), reached.end(), false);
  if (outside == reached.end()) return;
  const auto face = static_cast<Index>(outside - reached.begin());
  throw Error(
      BELTRAMI_E_COMPONENTS,
      "face " + quoted(face) + " is not connected to face 0: flatten each component on its own",
      Element::face(face));
}

/// Walks the boundary; throws CLOSED, BOUNDARIES or GENUS.
void trace_boundary(DiskMesh& mesh) {
  mesh.on_boundary.assign(mesh.vertex_count(), false);
  Index boundary_edges = 0;
  Index first = kNone;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    if (mesh.twin[h] != kNone) continue;
    ++boundary_edges;
    if (first == kNone) first = h;
    mesh.on_boundary[mesh.origin(h)] = true;
  }
  if (first == kNone) {
    throw Error(BELTRAMI_E_CLOSED,
                "the surface is closed, it has no boundary: cut it open along a seam first");
  }
  std::vector<bool> visited(mesh.vertex_count(), false);
  Index v = mesh.origin(first);
  do {
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

}  // namespace

void validate_indices(Index vertex_count, const std::vector<Triangle>& faces) {
  if (vertex_count == 0 || faces.empty()) {
    throw Error(BELTRAMI_E_EMPTY, "the mesh has no vertices or no faces: there is nothing to do");
  }
  for (Index f = 0; f < size_of(faces); ++f) {
    const Triangle& face = faces[f];
    for (const Index v : face) {
      if (v < 0 || v >= vertex_count) {
        throw Error(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                    "face " + quoted(f) + " names vertex " + quoted(v) + " of " +
                        quoted(vertex_count) + ": indices count from 0",
                    Element::face(f));
      }
    }
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      throw Error(BELTRAMI_E_REPEATED_VERTEX,
                  "face " + quoted(f) + " names one vertex twice: remove the face",
                  Element::face(f));
    }
  }
}

void validate_positions(const std::vector<Vec3>& positions) {
  for (Index v = 0; v < size_of(positions); ++v) {
    if (!positions[v].allFinite()) {
      throw Error(BELTRAMI_E_NON_FINITE,
                  "vertex " + quoted(v) + " has a coordinate that is infinite or not a number",
                  Element::vertex(v));
    }
  }
}

ReferencedVertices drop_unreferenced(Index vertex_count, std::vector<Triangle>& faces) {
  ReferencedVertices vertices;
  vertices.renumbered.assign(vertex_count, kNone);
  for (const Triangle& face : faces) {
    for (const Index v : face) vertices.renumbered[v] = 0;
  }
  for (Index v = 0; v < vertex_count; ++v) {
    if (vertices.renumbered[v] == kNone) continue;
    vertices.renumbered[v] = size_of(vertices.original);
    vertices.original.push_back(v);
  }
  for (Triangle& face : faces) {
    for (Index& v : face) v = vertices.renumbered[v];
  }
  return vertices;
}

DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces, int threads) {
  validate_indices(size_of(positions), faces);
  validate_positions(positions);
  DiskMesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  mesh.twin = pair_halfedges(mesh.vertex_count(), mesh.faces, threads);
  link_vertices(mesh, threads);
  require_one_component(mesh);
  trace_boundary(mesh);
  return mesh;
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

double surface_area(const DiskMesh& mesh) {
  double area = 0;
  for (const Triangle& face : mesh.faces) {
    area +=
        triangle_area(mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]);
  }
  return area;
}

Normalisation normalise(std::vector<Vec3>& positions, const std::vector<Triangle>& faces) {
  Vec3 low = positions.front(), high = positions.front();
  for (const Vec3& p : positions) {
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
  const auto rescale = [&](int exponent) {
    frame.scale = std::ldexp(frame.scale, exponent);
    for (Vec3& p : positions) {
      p = p.unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
    }
  };
  for (Vec3& p : positions) p -= frame.centre;
  rescale(-std::ilogb(extent));
  double area = 0;
  for (const Triangle& face : faces) {
    area += triangle_area(positions[face[0]], positions[face[1]], positions[face[2]]);
  }
  if (!(area > 0)) {
    throw Error(BELTRAMI_E_ZERO_AREA,
                "the surface has no area: every face is degenerate (check the vertex positions)");
  }
  // Nearest power of two to 1/sqrt(area).
  rescale(-static_cast<int>(std::lround(0.5 * std::log2(area))));
  return frame;
}

}  // namespace beltrami
