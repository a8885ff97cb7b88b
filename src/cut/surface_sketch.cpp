#include "cut/surface_sketch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/bucket_sort.h"
#include "base/disjoint_sets.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

/// Surfaces of no more vertices are their own sketches: a search looks at meshes of some 10,000
/// faces, which this leaves as they are.
constexpr Index kSmall = 6000;

/// Cells for the area of a surface: as many as the vertices of a mesh of 10,000 faces, as a surface
/// meets about half as many cells again as it could fill.
constexpr double kCells = 4000;

using Cell = std::array<std::int32_t, 3>;

void measure_faces(const Surface& surface, SurfaceSketch& sketch, const Work& work) {
  sketch.face_normals.resize(surface.faces.size());
  sketch.face_areas.resize(surface.faces.size());
  sketch.area =
      parallel_sum(work, surface.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
        double sum = 0;
        for (std::int64_t f = begin; f < end; ++f) {
          const auto [a, b, c] = surface.faces[f];
          const Vec3& p = surface.positions[a];
          const Vec3 twice = (surface.positions[b] - p).cross(surface.positions[c] - p);
          const double norm = twice.norm();
          sketch.face_areas[f] = norm / 2;
          sketch.face_normals[f] = norm > 0 ? Vec3(twice / norm) : Vec3(Vec3::Zero());
          sum += sketch.face_areas[f];
        }
        return sum;
      });
}

std::vector<Cell> cells_of(const Surface& surface, double size, const Work& work) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.positions) box.extend(p);
  // Far apart beyond the numbers of cells, vertices share the last one: edges connect clusters.
  constexpr double kLast = std::numeric_limits<std::int32_t>::max();
  std::vector<Cell> cells(surface.positions.size());
  parallel_for(work, size_of(cells), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Vec3 place = (surface.positions[v] - box.min()) / size;
      for (int i = 0; i < 3; ++i) {
        cells[v][i] = static_cast<std::int32_t>(std::min(std::floor(place[i]), kLast));
      }
    }
  });
  return cells;
}

/// Fills cluster_of; returns the number of clusters.
Index make_clusters(const Surface& surface, SurfaceSketch& sketch, const Work& work) {
  std::vector<Index>& cluster_of = sketch.cluster_of;
  cluster_of.assign(surface.positions.size(), kNone);
  Index count = 0;
  if (surface.vertex_count() <= kSmall || !(sketch.spacing > 0)) {
    for (Index v = 0; v < surface.vertex_count(); ++v) {
      if (surface.outgoing[v] != kNone) cluster_of[v] = count++;
    }
    return count;
  }
  const std::vector<Cell> cells = cells_of(surface, sketch.spacing, work);
  DisjointSets sets(surface.vertex_count());
  for (Index v = 0; v < surface.vertex_count(); ++v) sets.make(v);
  PollSometimes poll;
  for (const auto& [a, b, c] : surface.faces) {
    poll();
    if (cells[a] == cells[b]) sets.unite(a, b);
    if (cells[b] == cells[c]) sets.unite(b, c);
    if (cells[c] == cells[a]) sets.unite(c, a);
  }
  const std::vector<Index> roots = std::move(sets).roots();
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (surface.outgoing[v] == kNone) continue;
    cluster_of[v] = roots[v] == v ? count++ : cluster_of[roots[v]];
  }
  return count;
}

/// Positions, normals and areas, from the corners of the faces in their order.
void measure_clusters(const Surface& surface, Index count, SurfaceSketch& sketch) {
  sketch.areas.assign(count, 0);
  sketch.positions.assign(count, Vec3::Zero());
  sketch.normals.assign(count, Vec3::Zero());
  // For those without area.
  const double least = sketch.area > 0 ? 1e-9 * sketch.area / surface.face_count() : 1;
  std::vector<double> weights(count, 0);
  PollSometimes poll;
  for (Index f = 0; f < surface.face_count(); ++f) {
    poll();
    const double area = sketch.face_areas[f] / 3;
    for (const Index v : surface.faces[f]) {
      const Index c = sketch.cluster_of[v];
      sketch.areas[c] += area;
      weights[c] += area + least;
      sketch.positions[c] += (area + least) * surface.positions[v];
      sketch.normals[c] += area * sketch.face_normals[f];
    }
  }
  for (Index c = 0; c < count; ++c) {
    sketch.positions[c] /= weights[c];
    const double norm = sketch.normals[c].norm();
    if (norm > 0) sketch.normals[c] /= norm;
  }
}

void connect_clusters(const Surface& surface, SurfaceSketch& sketch, const Work& work) {
  const Index count = sketch.cluster_count();
  const auto cluster = [&](Index v) { return sketch.cluster_of[v]; };
  std::vector<Triangle> crossing;  // faces of two clusters or more
  PollSometimes poll;
  for (const auto& [a, b, c] : surface.faces) {
    poll();
    const Triangle face = {cluster(a), cluster(b), cluster(c)};
    if (face[0] == face[1] && face[1] == face[2]) continue;
    crossing.push_back(face);
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) {
      sketch.faces.push_back(face);
    }
  }
  std::vector<Index> start, ends;
  const auto each_edge = [&](std::int64_t f, const auto& visit) {
    for (int k = 0; k < 3; ++k) {
      const Index a = crossing[f][k], b = crossing[f][next_corner(k)];
      if (a == b) continue;
      visit(a, b);
      visit(b, a);
    }
  };
  BucketSort<Index> sort(work, size_of(crossing), count, start, [&](std::int64_t f, auto visit) {
    each_edge(f, [&](Index a, Index) { visit(a); });
  });
  ends.resize(start[count]);
  sort.place([&](std::int64_t f, auto place) {
    each_edge(f, [&](Index a, Index b) { ends[place(a)] = b; });
  });
  sketch.start.assign(1, 0);
  for (Index c = 0; c < count; ++c) {
    poll();
    const auto first = ends.begin() + start[c], last = ends.begin() + start[c + 1];
    std::sort(first, last);
    sketch.neighbours.insert(sketch.neighbours.end(), first, std::unique(first, last));
    sketch.start.push_back(size_of(sketch.neighbours));
  }
}

std::vector<Index> components(const SurfaceSketch& sketch) {
  DisjointSets sets(sketch.cluster_count());
  for (Index c = 0; c < sketch.cluster_count(); ++c) sets.make(c);
  for (Index c = 0; c < sketch.cluster_count(); ++c) {
    for (Index i = sketch.start[c]; i < sketch.start[c + 1]; ++i) {
      sets.unite(c, sketch.neighbours[i]);
    }
  }
  return std::move(sets).roots();
}

/// What is known of whole components, by their volume around their centre and their boundary.
void find_sides(const Surface& surface, SurfaceSketch& sketch) {
  const Index count = sketch.cluster_count();
  const std::vector<Index> component = components(sketch);
  std::vector<Vec3> centre(count, Vec3::Zero());
  std::vector<double> area(count, 0), volume(count, 0);
  for (Index c = 0; c < count; ++c) {
    area[component[c]] += sketch.areas[c];
    centre[component[c]] += sketch.areas[c] * sketch.positions[c];
  }
  for (Index c = 0; c < count; ++c) {
    const Index piece = component[c];
    if (!(area[piece] > 0)) continue;
    const Vec3 from_centre = sketch.positions[c] - centre[piece] / area[piece];
    volume[piece] += sketch.areas[c] * sketch.normals[c].dot(from_centre);
  }
  std::vector<bool> is_open(count, false);
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (surface.outgoing[v] == kNone || !surface.on_boundary[v]) continue;
    is_open[component[sketch.cluster_of[v]]] = true;
  }
  // A flat piece has no volume but for rounding, and its faces decide.
  const double least = 1e-9 * sketch.area * std::sqrt(sketch.area);
  sketch.on_open_piece.resize(count);
  sketch.inside_out.resize(count);
  for (Index c = 0; c < count; ++c) {
    sketch.on_open_piece[c] = is_open[component[c]];
    sketch.inside_out[c] = volume[component[c]] < -least;
  }
}

}  // namespace

SurfaceSketch sketch(const Surface& surface, const Work& work) {
  SurfaceSketch sketch;
  measure_faces(surface, sketch, work);
  sketch.spacing = std::sqrt(sketch.area / kCells);
  const Index count = make_clusters(surface, sketch, work);
  measure_clusters(surface, count, sketch);
  connect_clusters(surface, sketch, work);
  find_sides(surface, sketch);
  return sketch;
}

std::vector<double> carry_to_vertices(const SurfaceSketch& sketch, const Surface& surface,
                                      const std::vector<double>& values, const Work& work) {
  const bool is_small = sketch.positions.size() == surface.positions.size();
  const double reach = 2 * sketch.spacing;  // farther than the diagonal of a cell
  std::vector<double> carried(surface.positions.size(), 0);
  parallel_for(work, size_of(carried), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Index own = sketch.cluster_of[v];
      if (own == kNone) continue;
      const Vec3& p = surface.positions[v];
      // The own one counts, wherever it is.
      double weight = std::max(kernel((sketch.positions[own] - p).squaredNorm(), reach), 1e-6);
      double sum = weight * values[own];
      if (is_small) weight = 1, sum = values[own];
      for (Index i = sketch.start[own]; !is_small && i < sketch.start[own + 1]; ++i) {
        const Index c = sketch.neighbours[i];
        const double w = kernel((sketch.positions[c] - p).squaredNorm(), reach);
        weight += w;
        sum += w * values[c];
      }
      carried[v] = sum / weight;
    }
  });
  return carried;
}

}  // namespace beltrami
