#include "mesh/disk_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "mesh/locality.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
/// Of the exponent for the area, from a box of unit size: a surface that is nearly a line or a
/// point would grow until the fourth powers of its lengths leave the range of numbers.
constexpr int kMostGrowth = 40;

void require_one_component(const Surface& surface, const Work& work) {
  const std::vector<Index> least = connected_faces(surface, work);
  const auto outside =
      parallel_find(work, size_of(least), kGrain, [&](std::int64_t f) { return least[f] != 0; });
  if (outside == size_of(least)) return;
  throw Error(Fault::kComponents,
              "face " + std::to_string(outside) +
                  " is not connected to face 0: flatten each component on its own",
              Element::face(outside));
}

/// Whether boundary edges leave a vertex in several directions, or no face names a vertex: then
/// Euler's characteristic does not tell how many fans there are.
bool fans_need_proof(const Surface& surface, const Work& work) {
  const auto second = parallel_find(work, size_of(surface.twin), kGrain, [&](Index h) {
    return surface.twin[h] == kNone && surface.outgoing[surface.origin(h)] != h;
  });
  const auto unused = parallel_find(work, surface.vertex_count(), kGrain,
                                    [&](Index v) { return surface.outgoing[v] == kNone; });
  return second < size_of(surface.twin) || unused < surface.vertex_count();
}

/// Throws CLOSED, BOUNDARIES or GENUS.
void trace_boundary(DiskMesh& mesh, const Work& work) {
  const BoundaryLoops loops = boundary_loops(mesh, work);
  if (loops.count() == 0) {
    throw Error(Fault::kClosed,
                "the surface is closed, it has no boundary: cut it open along a seam first");
  }
  mesh.boundary.reserve(loops.start[1]);
  for (Index i = 0; i < loops.start[1]; ++i)
    mesh.boundary.push_back(mesh.origin(loops.halfedge[i]));
  if (loops.count() > 1) {
    Index other = mesh.vertex_count();
    for (Index i = loops.start[1]; i < size_of(loops.halfedge); ++i) {
      other = std::min(other, mesh.origin(loops.halfedge[i]));
    }
    throw Error(
        Fault::kBoundaries,
        "vertex " + std::to_string(other) +
            " lies on a second boundary loop: fill the hole, or cut from it to the boundary",
        Element::vertex(other));
  }
  const std::int64_t edges = edge_count(mesh.face_count(), size_of(mesh.boundary));
  const std::int64_t euler = mesh.vertex_count() - edges + mesh.face_count();
  if (euler != 1) {
    throw Error(Fault::kGenus, "the surface has " + std::to_string((1 - euler) / 2) +
                                   " handle(s), genus above 0: cut them open first");
  }
}

void require_disk(DiskMesh& mesh, const Work& work) {
  require_one_component(mesh, work);
  trace_boundary(mesh, work);
}

double total_area(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                  const Work& work) {
  return parallel_sum(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    double area = 0;
    for (std::int64_t f = begin; f < end; ++f) {
      area += triangle_area(positions[faces[f][0]], positions[faces[f][1]], positions[faces[f][2]]);
    }
    return area;
  });
}

}  // namespace

std::vector<Index> drop_unreferenced(Index vertex_count, std::vector<Triangle>& faces,
                                     const Work& work) {
  std::vector<std::uint8_t> used;
  parallel_assign(work, used, static_cast<std::size_t>(vertex_count));
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (const Index v : faces[f]) {
        std::atomic_ref<std::uint8_t>(used[v]).store(1, std::memory_order_relaxed);
      }
    }
  });
  std::vector<Index> original =
      parallel_filter(work, vertex_count, kGrain, [&](Index v) { return used[v] != 0; });
  if (size_of(original) == vertex_count) return original;
  Scratch<Index> renumbered(work, used.size());
  parallel_for(work, size_of(original), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) renumbered[original[v]] = v;
  });
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      for (Index& v : faces[f]) v = renumbered[v];
    }
  });
  return original;
}

DiskMesh prove_disk(Surface surface, const Work& work) {
  DiskMesh mesh{std::move(surface), {}};
  require_disk(mesh, work);
  return mesh;
}

DiskMesh build_disk(std::vector<Vec3> positions, std::vector<Triangle> faces, const Work& work) {
  DiskMesh mesh{connect_faces(std::move(positions), std::move(faces), work), {}};
  // A disk's vertices have one fan each, without a look at them: a connected surface with one
  // boundary loop has an Euler characteristic of at most 1, and each further fan of a vertex lowers
  // it by one. Not so where an unused vertex makes up for a fan; and where two fans of a vertex
  // reach the boundary, following that might never end.
  if (fans_need_proof(mesh, work)) prove_fans(mesh, work);
  try {
    require_disk(mesh, work);
  } catch (const Error&) {
    prove_fans(mesh, work);
    throw;
  }
  return mesh;
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

double surface_area(const Surface& surface, const Work& work) {
  return total_area(surface.positions, surface.faces, work);
}

Normalisation normalise(std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                        const Work& work) {
  const Eigen::AlignedBox3d box = bounding_box(positions, work);
  Normalisation frame;
  frame.centre = 0.5 * box.min() + 0.5 * box.max();
  // The extent first, so that the area of a mesh of any unit neither under- nor overflows.
  const double extent = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
  if (!(extent > 0)) {
    throw Error(Fault::kZeroArea, "all vertices coincide: the surface has no area");
  }
  const auto rescale = [&](const Vec3& centre, int exponent) {
    frame.exponent += exponent;
    // Two factors, since one alone could leave the range of numbers that their product stays in.
    const double half = std::ldexp(1.0, exponent / 2),
                 rest = std::ldexp(1.0, exponent - exponent / 2);
    parallel_for(work, size_of(positions), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v) {
        positions[v] = (positions[v] - centre) * half * rest;
      }
    });
  };
  rescale(frame.centre, -std::ilogb(extent));
  const double area = total_area(positions, faces, work);
  if (!(area > 0)) {
    throw Error(Fault::kZeroArea,
                "the surface has no area: every face is degenerate (check the vertex positions)");
  }
  // Nearest power of two to 1/sqrt(area).
  rescale(Vec3::Zero(), std::min(kMostGrowth, -((std::ilogb(area) + 1) >> 1)));
  return frame;
}

}  // namespace beltrami
