#include "simplify/surface.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/interrupt.h"

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

/// One boundary vertex strictly between two positions of the loop, nearest the middle by length.
Index middle_of_loop(const DiskMesh& mesh, Index begin, Index end) {
  const Index count = size_of(mesh.boundary);
  const auto edge_length = [&](Index i) {
    const Vec3& from = mesh.positions[mesh.boundary[i % count]];
    return (mesh.positions[mesh.boundary[(i + 1) % count]] - from).norm();
  };
  double total = 0;
  for (Index i = begin; i < end; ++i) total += edge_length(i);
  Index middle = begin + 1;
  double before = edge_length(begin);
  while (middle + 1 < end && before + 0.5 * edge_length(middle) < 0.5 * total) {
    before += edge_length(middle++);
  }
  return mesh.boundary[middle % count];
}

/// Fixes ear tips, bridge ends, and one vertex between bridge ends that follow each other on the
/// loop, else the patch behind the bridge could lose all its width.
void fix_boundary(const DiskMesh& mesh, std::vector<Role>& role) {
  std::vector<bool> bridge_end(mesh.vertex_count(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index from = mesh.origin(h), to = mesh.target(h);
    if (mesh.twin[h] == kNone || !mesh.on_boundary[from] || !mesh.on_boundary[to]) continue;
    bridge_end[from] = bridge_end[to] = true;
  }
  std::vector<Index> ends;  // positions on the loop
  for (Index i = 0; i < size_of(mesh.boundary); ++i) {
    const Index v = mesh.boundary[i];
    role[v] = Role::kBoundary;
    if (bridge_end[v]) ends.push_back(i);
    const bool ear_tip = mesh.rotate(mesh.outgoing[v]) == kNone;
    if (bridge_end[v] || ear_tip) role[v] = Role::kFixedBoundary;
  }
  for (Index e = 0; e < size_of(ends); ++e) {
    const bool last = e + 1 == size_of(ends);
    const Index end = last ? ends.front() + size_of(mesh.boundary) : ends[e + 1];
    if (end - ends[e] > 1) role[middle_of_loop(mesh, ends[e], end)] = Role::kFixedBoundary;
  }
}

double longest_edge_sq(const DiskMesh& mesh, const Triangle& face) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3& from = mesh.positions[face[k]];
    longest = std::max(longest, (mesh.positions[face[next_corner(k)]] - from).squaredNorm());
  }
  return longest;
}

/// Holds a boundary edge in place: through the plane across its face or, where `face_normal` is
/// zero because the face is degenerate, through two planes along the edge.
void add_boundary_quadric(const Vec3& edge, const Vec3& face_normal, Quadric& from, Quadric& to) {
  const double length = edge.norm();
  if (!(length > 0)) return;
  const double weight = kBoundaryWeight * length * length;
  const Vec3 along = edge / length;
  const bool degenerate = face_normal.isZero(0);
  const Vec3 across = degenerate ? along.unitOrthogonal() : face_normal.cross(along).eval();
  for (Quadric* quadric : {&from, &to}) {
    quadric->add_plane(across, weight);
    if (degenerate) quadric->add_plane(along.cross(across), weight);
  }
}

}  // namespace

std::vector<Role> vertex_roles(const DiskMesh& mesh) {
  std::vector<Role> roles(mesh.vertex_count(), Role::kInterior);
  fix_boundary(mesh, roles);
  return roles;
}

Index least_boundary(const DiskMesh& mesh) {
  return std::min(size_of(mesh.boundary), kMinBoundary);
}

std::vector<Quadric> vertex_quadrics(const DiskMesh& mesh, FacePlanes planes) {
  std::vector<Quadric> quadrics(mesh.vertex_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& face = mesh.faces[f];
    const Vec3& p = mesh.positions[face[0]];
    Vec3 normal = (mesh.positions[face[1]] - p).cross(mesh.positions[face[2]] - p);
    const double twice_area = normal.norm();
    if (twice_area > 0) {
      normal /= twice_area;
      if (planes == FacePlanes::kIncluded) {
        for (const Index v : face) quadrics[v].add_plane(normal, 0.5 * twice_area);
      }
    } else {
      normal.setZero();
      // No plane: its vertices go first, but to near places before far ones.
      const double weight = longest_edge_sq(mesh, face) * kDegenerateWidth;
      for (const Index v : face) quadrics[v].add_point(weight);
    }
    for (int k = 0; k < 3; ++k) {
      if (mesh.twin[3 * f + k] != kNone) continue;
      const Index from = face[k], to = face[next_corner(k)];
      add_boundary_quadric(mesh.positions[to] - mesh.positions[from], normal, quadrics[from],
                           quadrics[to]);
    }
  }
  return quadrics;
}

ShrinkingSurface make_surface(const DiskMesh& mesh) {
  const Index vertex_count = mesh.vertex_count();
  ShrinkingSurface surface;
  surface.site.reserve(vertex_count);
  for (const Vec3& p : mesh.positions) surface.site.push_back({p, 0});
  surface.loop_next.assign(vertex_count, kNone);
  surface.loop_previous.assign(vertex_count, kNone);
  surface.fine_vertex.resize(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) surface.fine_vertex[v] = v;
  surface.collapsed_into = surface.fine_vertex;
  surface.faces = mesh.faces;
  surface.live_faces = mesh.face_count();
  surface.boundary_count = size_of(mesh.boundary);
  surface.min_boundary = least_boundary(mesh);
  for (Index i = 0; i < size_of(mesh.boundary); ++i) {
    const Index v = mesh.boundary[i];
    const Index next = mesh.boundary[i + 1 == size_of(mesh.boundary) ? 0 : i + 1];
    surface.loop_next[v] = next;
    surface.loop_previous[next] = v;
  }
  surface.role = vertex_roles(mesh);
  poll_interrupt();
  surface.quadric = vertex_quadrics(mesh, FacePlanes::kIncluded);
  return surface;
}

void compact(ShrinkingSurface& surface) {
  std::vector<Index> renumbered(surface.vertex_count(), kNone);
  Index kept = 0;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (surface.role[v] == Role::kRemoved) continue;
    renumbered[v] = kept;
    surface.site[kept] = surface.site[v];
    surface.quadric[kept] = surface.quadric[v];
    surface.role[kept] = surface.role[v];
    surface.loop_next[kept] = surface.loop_next[v];
    surface.loop_previous[kept] = surface.loop_previous[v];
    surface.fine_vertex[kept] = surface.fine_vertex[v];
    ++kept;
  }
  surface.site.resize(kept);
  surface.quadric.resize(kept);
  surface.role.resize(kept);
  surface.loop_next.resize(kept);
  surface.loop_previous.resize(kept);
  surface.fine_vertex.resize(kept);
  for (Index v = 0; v < kept; ++v) {
    if (!surface.on_boundary(v)) continue;
    surface.loop_next[v] = renumbered[surface.loop_next[v]];
    surface.loop_previous[v] = renumbered[surface.loop_previous[v]];
  }
  std::erase_if(surface.faces, [](const Triangle& face) { return face[0] == kNone; });
  for (Triangle& face : surface.faces) {
    for (Index& v : face) v = renumbered[v];
  }
}

void begin_pass(ShrinkingSurface& surface) {
  compact(surface);
  poll_interrupt();
  // Counting sort of the half-edges by origin.
  const Index vertex_count = surface.vertex_count();
  surface.valence.assign(vertex_count, 0);
  for (const Triangle& face : surface.faces) {
    for (const Index v : face) ++surface.valence[v];
  }
  surface.fan_start.resize(vertex_count + 1);
  Index total = 0;
  for (Index v = 0; v < vertex_count; ++v) {
    surface.fan_start[v] = total;
    total += surface.valence[v];
  }
  surface.fan_start[vertex_count] = total;
  surface.fan.resize(total);
  // `mark` serves as the cursor first.
  surface.mark.assign(surface.fan_start.begin(), surface.fan_start.end() - 1);
  for (Index f = 0; f < size_of(surface.faces); ++f) {
    for (int k = 0; k < 3; ++k) surface.fan[surface.mark[surface.faces[f][k]]++] = 3 * f + k;
  }
  surface.mark.assign(vertex_count, kNone);
  surface.locked.assign(vertex_count, false);
}

}  // namespace beltrami
