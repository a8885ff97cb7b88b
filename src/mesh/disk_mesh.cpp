#include "mesh/disk_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace beltrami {
namespace {

std::string quoted(Index index) {
  return std::to_string(index);
}

/// Pairs half-edges by counting sort over the smaller end vertex: no hash map, no comparison sort.
/// Throws NON_MANIFOLD_EDGE or ORIENTATION with the later face concerned.
std::vector<Index> pair_halfedges(Index vertex_count, const std::vector<Triangle>& faces) {
  const Index halfedge_count = 3 * size_of(faces);
  std::vector<Index> start(vertex_count + 1, 0);
  const auto ends = [&](Index h) {
    const Triangle& face = faces[h / 3];
    return std::array<Index, 2>{face[h % 3], face[next_corner(h % 3)]};
  };
  for (Index h = 0; h < halfedge_count; ++h) {
    const auto [from, to] = ends(h);
    ++start[std::min(from, to) + 1];
  }
  for (Index v = 0; v < vertex_count; ++v) start[v + 1] += start[v];
  std::vector<Index> bucket(halfedge_count);
  {
    std::vector<Index> cursor(start.begin(), start.end() - 1);
    for (Index h = 0; h < halfedge_count; ++h) {
      const auto [from, to] = ends(h);
      bucket[cursor[std::min(from, to)]++] = h;
    }
  }

  std::vector<Index> twin(halfedge_count, kNone);
  // For the larger end vertex: the half-edges seen in the current bucket, in each direction.
  struct Seen {
    Index bucket = kNone, up = kNone, down = kNone;
  };
  std::vector<Seen> seen(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) {
    for (Index i = start[v]; i < start[v + 1]; ++i) {
      const Index h = bucket[i];
      const auto [from, to] = ends(h);
      Seen& other = seen[std::max(from, to)];
      if (other.bucket != v) other = {v, kNone, kNone};
      Index& same = from < to ? other.up : other.down;
      Index& opposite = from < to ? other.down : other.up;
      if (same != kNone) {
        const std::string edge = "the edge " + quoted(from) + "-" + quoted(to);
        if (opposite != kNone) {
          throw Error(BELTRAMI_E_NON_MANIFOLD_EDGE,
                      "face " + quoted(h / 3) + " is at least the third on " + edge +
                          ": split the surface there, so that no edge has more than two faces",
                      Element::face(h / 3));
        }
        // A third face on the edge makes it non-manifold, whichever way it runs.
        const bool third = std::any_of(bucket.begin() + i + 1, bucket.begin() + start[v + 1],
                                       [&, larger = std::max(from, to)](Index g) {
                                         const auto [a, b] = ends(g);
                                         return std::max(a, b) == larger;
                                       });
        if (third) {
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
      same = h;
      if (opposite != kNone) {
        twin[h] = opposite;
        twin[opposite] = h;
      }
    }
  }
  return twin;
}

/// Fills `outgoing`; throws NON_MANIFOLD_VERTEX where the faces of a vertex form several fans.
void link_vertices(DiskMesh& mesh) {
  const Index vertex_count = mesh.vertex_count();
  mesh.outgoing.assign(vertex_count, kNone);
  std::vector<Index> valence(vertex_count, 0);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index v = mesh.origin(h);
    ++valence[v];
    if (mesh.outgoing[v] == kNone || mesh.twin[h] == kNone) mesh.outgoing[v] = h;
  }
  for (Index v = 0; v < vertex_count; ++v) {
    if (mesh.outgoing[v] == kNone) continue;
    Index fan = 0;
    mesh.for_each_outgoing(v, [&](Index) { ++fan; });
    if (fan != valence[v]) {
      throw Error(BELTRAMI_E_NON_MANIFOLD_VERTEX,
                  "the faces around vertex " + quoted(v) +
                      " form more than one fan: duplicate the vertex, one copy for each fan",
                  Element::vertex(v));
    }
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

DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces) {
  validate_indices(size_of(positions), faces);
  validate_positions(positions);
  DiskMesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  mesh.twin = pair_halfedges(mesh.vertex_count(), mesh.faces);
  link_vertices(mesh);
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
