#include "simplify/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>

#include "base/bucket_sort.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "mesh/face_chunks.h"

namespace beltrami {
namespace {

using Role = ShrinkingSurface::Role;

/// The loop keeps at least this many vertices (or all it has): fewer leave the flattened boundary
/// too little freedom.
constexpr Index kMinBoundary = 8;

/// A boundary edge weighs as much as a plane of this many times its squared length.
constexpr double kBoundaryWeight = 10;

/// A face without area weighs as much as one of this width over its length.
constexpr double kDegenerateWidth = 1e-6;

constexpr std::int64_t kGrain = 4096;

/// One boundary vertex strictly between two positions of the loop, nearest the middle by length.
Index middle_of_loop(const Surface& mesh, const std::vector<Index>& loop, Index begin, Index end) {
  const Index count = size_of(loop);
  const auto edge_length = [&](Index i) {
    const Vec3& from = mesh.positions[loop[i % count]];
    return (mesh.positions[loop[(i + 1) % count]] - from).norm();
  };
  double total = 0;
  for (Index i = begin; i < end; ++i) total += edge_length(i);
  Index middle = begin + 1;
  double before = edge_length(begin);
  while (middle + 1 < end && before + 0.5 * edge_length(middle) < 0.5 * total) {
    before += edge_length(middle++);
  }
  return loop[middle % count];
}

/// Fixes ear tips, bridge ends, and one vertex between bridge ends that follow each other on the
/// loop, else the patch behind the bridge could lose all its width.
void fix_boundary(const Surface& mesh, const std::vector<Index>& loop,
                  std::vector<bool>& bridge_end, std::vector<Role>& role) {
  for (const Index v : loop) {
    mesh.for_each_outgoing(v, [&](Index h) {
      if (mesh.twin[h] != kNone && mesh.on_boundary[mesh.target(h)]) bridge_end[v] = true;
    });
  }
  std::vector<Index> ends;  // positions on the loop
  for (Index i = 0; i < size_of(loop); ++i) {
    const Index v = loop[i];
    role[v] = Role::kBoundary;
    if (bridge_end[v]) ends.push_back(i);
    const bool ear_tip = mesh.rotate(mesh.outgoing[v]) == kNone;
    if (bridge_end[v] || ear_tip) role[v] = Role::kFixedBoundary;
  }
  for (Index e = 0; e < size_of(ends); ++e) {
    const bool last = e + 1 == size_of(ends);
    const Index end = last ? ends.front() + size_of(loop) : ends[e + 1];
    if (end - ends[e] > 1) role[middle_of_loop(mesh, loop, ends[e], end)] = Role::kFixedBoundary;
  }
}

double longest_edge_sq(const Surface& mesh, const Triangle& face) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3& from = mesh.positions[face[k]];
    longest = std::max(longest, (mesh.positions[face[next_corner(k)]] - from).squaredNorm());
  }
  return longest;
}

/// Holds a boundary edge in place: through the plane across its face or, where `face_normal` is
/// zero because the face is degenerate, through two planes along the edge.
void add_boundary_quadric(const Vec3& edge, const Vec3& face_normal, Quadric& end) {
  const double length = edge.norm();
  if (!(length > 0)) return;
  const double weight = kBoundaryWeight * length * length;
  const Vec3 along = edge / length;
  const bool degenerate = face_normal.isZero(0);
  const Vec3 across = degenerate ? along.unitOrthogonal() : face_normal.cross(along).eval();
  end.add_plane(across, weight);
  if (degenerate) end.add_plane(along.cross(across), weight);
}

/// Adds what a face and its boundary edges give to the quadrics `of` its vertices; where that is
/// null, the vertex gets nothing.
template <class Of>
void add_face_quadrics(const Surface& mesh, Index f, FacePlanes planes, const Of& of) {
  const Triangle& face = mesh.faces[f];
  const std::array<Quadric*, 3> quadrics = {of(face[0]), of(face[1]), of(face[2])};
  const Vec3& p = mesh.positions[face[0]];
  Vec3 normal = (mesh.positions[face[1]] - p).cross(mesh.positions[face[2]] - p);
  const double twice_area = normal.norm();
  if (twice_area > 0) {
    normal /= twice_area;
  } else {
    normal.setZero();
  }
  for (Quadric* quadric : quadrics) {
    if (quadric == nullptr) continue;
    if (!(twice_area > 0)) {
      // No plane: its vertices go first, but to near places before far ones.
      quadric->add_point(longest_edge_sq(mesh, face) * kDegenerateWidth);
    } else if (planes == FacePlanes::kIncluded) {
      quadric->add_plane(normal, 0.5 * twice_area);
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (mesh.twin[3 * f + k] != kNone) continue;
    const Vec3 edge = mesh.positions[face[next_corner(k)]] - mesh.positions[face[k]];
    for (Quadric* quadric : {quadrics[k], quadrics[next_corner(k)]}) {
      if (quadric != nullptr) add_boundary_quadric(edge, normal, *quadric);
    }
  }
}

}  // namespace

std::vector<Role> vertex_roles(const Surface& mesh, const VertexLoops& loops) {
  std::vector<Role> roles(mesh.vertex_count(), Role::kInterior);
  std::vector<bool> bridge_end(mesh.vertex_count(), false);
  for (const std::vector<Index>& loop : loops) fix_boundary(mesh, loop, bridge_end, roles);
  return roles;
}

Index least_boundary(Index loop_size) {
  return std::min(loop_size, kMinBoundary);
}

std::vector<Quadric> vertex_quadrics(const Surface& mesh, FacePlanes planes, const Work& work) {
  std::vector<Quadric> quadrics;
  parallel_assign(work, quadrics, mesh.positions.size());
  const FaceChunks chunks(mesh.vertex_count(), mesh.faces, work);
  struct Aside {
    Index vertex, face;
  };
  PutAside<Aside> aside(chunks, mesh.vertex_count());
  parallel_for(work, mesh.face_count(), chunks.grain(), [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      add_face_quadrics(mesh, f, planes,
                        [&](Index v) { return chunks.shared(v) ? nullptr : &quadrics[v]; });
      for (const Index v : mesh.faces[f]) {
        if (chunks.shared(v)) aside.put(chunks.of(f), v, {v, f});
      }
    }
  });
  aside.add_up(work, [&](const Aside& a) {
    add_face_quadrics(mesh, a.face, planes,
                      [&](Index v) { return v == a.vertex ? &quadrics[v] : nullptr; });
  });
  return quadrics;
}

ShrinkingSurface make_surface(const Surface& mesh, const VertexLoops& loops, const Work& work) {
  const Index vertex_count = mesh.vertex_count();
  ShrinkingSurface surface;
  parallel_assign(work, surface.site, mesh.positions.size());
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) surface.site[v] = {mesh.positions[v], 0};
  });
  surface.loop_next.assign(vertex_count, kNone);
  surface.loop_previous.assign(vertex_count, kNone);
  surface.fine_vertex.resize(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) surface.fine_vertex[v] = v;
  surface.collapsed_into = surface.fine_vertex;
  surface.faces = mesh.faces;
  surface.live_faces = mesh.face_count();
  surface.loop_of.assign(vertex_count, kNone);
  for (const std::vector<Index>& loop : loops) {
    const Index number = size_of(surface.loop_size), size = size_of(loop);
    surface.loop_size.push_back(size);
    surface.least_size.push_back(least_boundary(size));
    for (Index i = 0; i < size; ++i) {
      const Index v = loop[i], next = loop[i + 1 == size ? 0 : i + 1];
      surface.loop_of[v] = number;
      surface.loop_next[v] = next;
      surface.loop_previous[next] = v;
    }
  }
  surface.role = vertex_roles(mesh, loops);
  poll_interrupt();
  surface.quadric = vertex_quadrics(mesh, FacePlanes::kIncluded, work);
  return surface;
}

namespace {

/// items[i] = items[kept[i]], and no more of them.
template <class Item>
void keep(const std::vector<Index>& kept, std::vector<Item>& items, const Work& work) {
  if (kept.size() == items.size()) return;
  Scratch<Item> of_kept(work, kept.size());
  parallel_for(work, size_of(kept), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) of_kept[i] = items[kept[i]];
  });
  parallel_for(work, size_of(kept), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) items[i] = of_kept[i];
  });
  items.resize(kept.size());
}

}  // namespace

void compact(ShrinkingSurface& surface, const Work& work) {
  const std::vector<Index> vertices =
      parallel_filter(work, surface.vertex_count(), kGrain,
                      [&](Index v) { return surface.role[v] != Role::kRemoved; });
  const std::vector<Index> faces = parallel_filter(
      work, size_of(surface.faces), kGrain, [&](Index f) { return surface.faces[f][0] != kNone; });
  Scratch<Index> renumbered(work, surface.site.size());
  parallel_for(work, size_of(vertices), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) renumbered[vertices[v]] = v;
  });
  keep(vertices, surface.quadric, work);
  keep(vertices, surface.site, work);
  keep(vertices, surface.role, work);
  keep(vertices, surface.fine_vertex, work);
  keep(vertices, surface.loop_next, work);
  keep(vertices, surface.loop_previous, work);
  keep(faces, surface.faces, work);
  if (surface.keeps_history) keep(faces, surface.fine_face, work);
  const auto renumber = [&](Index& v) { v = v == kNone ? kNone : renumbered[v]; };
  parallel_for(work, size_of(vertices), kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::for_each(surface.loop_next.begin() + begin, surface.loop_next.begin() + end, renumber);
    std::for_each(surface.loop_previous.begin() + begin, surface.loop_previous.begin() + end,
                  renumber);
  });
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (Index& v : surface.faces[f]) v = renumbered[v];
    }
  });
}

void begin_pass(ShrinkingSurface& surface, const Work& work) {
  compact(surface, work);
  poll_interrupt();
  // The half-edges by origin.
  const Index vertex_count = surface.vertex_count();
  BucketSort<Index> sort(work, size_of(surface.faces), vertex_count, surface.fan_start,
                         [&](std::int64_t f, const auto& count) {
                           for (const Index v : surface.faces[f]) count(v);
                         });
  surface.fan.resize(3 * surface.faces.size());
  sort.place([&](std::int64_t f, const auto& place) {
    for (int k = 0; k < 3; ++k) {
      surface.fan[place(surface.faces[f][k])] = static_cast<Index>(3 * f + k);
    }
  });
  surface.valence.resize(vertex_count);
  parallel_for(work, vertex_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      surface.valence[v] = surface.fan_start[v + 1] - surface.fan_start[v];
    }
  });
  surface.mark.assign(vertex_count, kNone);
  surface.locked.assign(vertex_count, false);
}

}  // namespace beltrami
