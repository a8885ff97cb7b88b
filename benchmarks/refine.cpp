#include "refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "files/mesh_file.h"
#include "files/triangulate.h"

namespace beltrami::benchmarks {
namespace {

using Point = std::array<double, 3>;

Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Point operator*(double s, const Point& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

Point point(const TriangleMesh& mesh, std::uint32_t v) {
  return {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
}

void append(TriangleMesh& mesh, const Point& p) {
  mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
}

struct Edge {
  std::uint32_t a, b;  // a < b
  std::uint32_t faces = 0;
  std::array<std::uint32_t, 2> opposite = {0, 0};
  double length_sq = 0;
};

struct Edges {
  std::vector<Edge> list;
  std::vector<std::uint32_t> of_corner;  // edge from corner k to k + 1 of each face
};

Edges find_edges(const TriangleMesh& mesh) {
  const std::size_t corners = mesh.faces.size();
  const auto next = [](std::size_t c) { return c % 3 == 2 ? c - 2 : c + 1; };
  const auto key = [&](std::size_t c) {
    const std::uint64_t a = mesh.faces[c], b = mesh.faces[next(c)];
    return std::min(a, b) << 32 | std::max(a, b);
  };
  std::vector<std::uint32_t> order(corners);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t c, std::uint32_t d) {
    return key(c) < key(d) || (key(c) == key(d) && c < d);
  });
  Edges edges;
  edges.of_corner.resize(corners);
  for (std::size_t i = 0; i < corners; ++i) {
    const std::uint32_t c = order[i];
    if (i == 0 || key(order[i - 1]) != key(c)) {
      Edge edge{static_cast<std::uint32_t>(key(c) >> 32), static_cast<std::uint32_t>(key(c))};
      const Point d = point(mesh, edge.a) + -1.0 * point(mesh, edge.b);
      edge.length_sq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      edges.list.push_back(edge);
    }
    Edge& edge = edges.list.back();
    if (edge.faces < 2) edge.opposite[edge.faces] = mesh.faces[next(next(c))];
    ++edge.faces;
    edges.of_corner[c] = static_cast<std::uint32_t>(edges.list.size() - 1);
  }
  return edges;
}

/// Loop's masks for the old vertices.
void smooth_vertices(const TriangleMesh& mesh, const Edges& edges, TriangleMesh& fine) {
  const std::size_t count = mesh.vertex_count();
  std::vector<Point> ring(count, {0, 0, 0}), rim(count, {0, 0, 0});
  std::vector<int> valence(count, 0);
  std::vector<bool> on_boundary(count, false);
  for (const Edge& edge : edges.list) {
    for (const auto& [v, w] : {std::pair{edge.a, edge.b}, std::pair{edge.b, edge.a}}) {
      ring[v] = ring[v] + point(mesh, w);
      ++valence[v];
      if (edge.faces != 1) continue;
      rim[v] = rim[v] + point(mesh, w);
      on_boundary[v] = true;
    }
  }
  for (std::uint32_t v = 0; v < count; ++v) {
    if (on_boundary[v]) {
      append(fine, 0.75 * point(mesh, v) + 0.125 * rim[v]);
      continue;
    }
    const double n = std::max(valence[v], 3);
    const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
    const double beta = (0.625 - c * c) / n;
    append(fine, (1 - n * beta) * point(mesh, v) + beta * ring[v]);
  }
}

TriangleMesh subdivide(const TriangleMesh& mesh) {
  const Edges edges = find_edges(mesh);
  TriangleMesh fine;
  smooth_vertices(mesh, edges, fine);
  for (const Edge& edge : edges.list) {
    const Point ends = point(mesh, edge.a) + point(mesh, edge.b);
    const Point wings = point(mesh, edge.opposite[0]) + point(mesh, edge.opposite[1]);
    append(fine, edge.faces == 2 ? 0.375 * ends + 0.125 * wings : 0.5 * ends);
  }
  const auto old_count = static_cast<std::uint32_t>(mesh.vertex_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t *v = &mesh.faces[3 * f], *e = &edges.of_corner[3 * f];
    const std::uint32_t ab = old_count + e[0], bc = old_count + e[1], ca = old_count + e[2];
    fine.faces.insert(fine.faces.end(), {v[0], ab, ca, ab, v[1], bc, ca, bc, v[2], ab, bc, ca});
  }
  return fine;
}

/// Splits edges that are the longest of all their faces, longest first.
TriangleMesh split_longest(const TriangleMesh& mesh, std::uint64_t faces) {
  const Edges edges = find_edges(mesh);
  std::vector<std::size_t> longest(mesh.face_count());  // corner
  std::vector<std::uint32_t> votes(edges.list.size(), 0);
  const auto longer = [&](std::uint32_t e, std::uint32_t f) {
    const double a = edges.list[e].length_sq, b = edges.list[f].length_sq;
    return a > b || (a == b && e > f);
  };
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    longest[f] = 3 * f;
    for (std::size_t c = 3 * f + 1; c < 3 * f + 3; ++c) {
      if (longer(edges.of_corner[c], edges.of_corner[longest[f]])) longest[f] = c;
    }
    ++votes[edges.of_corner[longest[f]]];
  }
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t e = 0; e < edges.list.size(); ++e) {
    if (votes[e] == edges.list[e].faces) candidates.push_back(e);
  }
  std::sort(candidates.begin(), candidates.end(), longer);
  TriangleMesh fine = mesh;
  std::vector<std::uint32_t> middle(edges.list.size(), 0);
  std::uint64_t count = mesh.face_count();
  for (const std::uint32_t e : candidates) {
    if (count >= faces) break;
    count += edges.list[e].faces;
    middle[e] = static_cast<std::uint32_t>(fine.vertex_count());
    append(fine, 0.5 * (point(mesh, edges.list[e].a) + point(mesh, edges.list[e].b)));
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t m = middle[edges.of_corner[longest[f]]];
    if (m == 0) continue;
    const std::size_t k = longest[f] % 3;
    const std::uint32_t a = mesh.faces[3 * f + k], b = mesh.faces[3 * f + (k + 1) % 3],
                        c = mesh.faces[3 * f + (k + 2) % 3];
    const std::array<std::uint32_t, 3> half = {a, m, c};
    std::copy(half.begin(), half.end(), fine.faces.begin() + static_cast<std::ptrdiff_t>(3 * f));
    fine.faces.insert(fine.faces.end(), {m, b, c});
  }
  return fine;
}

}  // namespace

TriangleMesh read_triangles(const std::string& path) {
  cli::MeshFile file = cli::read_mesh(path, cli::Content::kSurface);
  std::vector<std::uint32_t> faces = cli::triangulate(file);
  return {std::move(file.positions), std::move(faces)};
}

TriangleMesh refine(const TriangleMesh& mesh, std::uint64_t faces) {
  TriangleMesh fine = mesh;
  while (4 * fine.face_count() <= faces + faces / 20) fine = subdivide(fine);
  while (fine.face_count() < faces - faces / 200) fine = split_longest(fine, faces);
  return fine;
}

}  // namespace beltrami::benchmarks
