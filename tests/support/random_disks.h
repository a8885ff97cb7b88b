// Disks that nobody chose: a random base, bent, glued and spoilt at random.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami::disks {

inline void scale_axes(Random& random, double most, meshes::TriangleList& mesh) {
  const double range = portable::log(most);
  const double y = portable::exp(range * random.unit()), x = portable::exp(range * random.unit());
  const Vec3 factor(x, y, 1);
  for (Vec3& p : mesh.positions) p = p.cwiseProduct(factor);
}

inline void add_noise(Random& random, double share, meshes::TriangleList& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.faces) {
    sum += (mesh.positions[t[1]] - mesh.positions[t[0]]).norm();
  }
  const double length = share * sum / static_cast<double>(mesh.faces.size());
  for (Vec3& p : mesh.positions) p += length * random.vec3();
}

inline void add_spikes(Random& random, meshes::TriangleList& mesh) {
  const int count = 1 + random.below(4);
  for (int i = 0; i < count; ++i) {
    const int v = random.below(static_cast<int>(mesh.positions.size()));
    const Vec3 direction = random.vec3();
    mesh.positions[v] += random.between(1, 30) * direction;
  }
}

/// Faces glued to boundary edges by one edge each.
inline void add_ears(Random& random, meshes::TriangleList& mesh) {
  const DiskMesh disk = build_disk(mesh.positions, mesh.faces, Work(1));
  const Index count = size_of(disk.boundary);
  for (Index i = 0; i < count; ++i) {
    if (random.below(4) != 0) continue;
    const Index a = disk.boundary[i], b = disk.boundary[(i + 1) % count];
    const Vec3 middle = 0.5 * (mesh.positions[a] + mesh.positions[b]);
    const double length = (mesh.positions[b] - mesh.positions[a]).norm();
    mesh.faces.push_back({b, a, size_of(mesh.positions)});
    mesh.positions.push_back(middle + length * random.vec3());
  }
}

/// Flips interior edges at random, for vertices of high degree and bridges.
inline void flip_edges(Random& random, meshes::TriangleList& mesh) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    const DiskMesh disk = build_disk(mesh.positions, mesh.faces, Work(1));
    const Index h = random.below(static_cast<int>(disk.twin.size()));
    if (disk.twin[h] == kNone) continue;
    const Index t = disk.twin[h];
    const Index p = disk.origin(h), q = disk.target(h);
    const Index r = disk.origin(DiskMesh::previous(h)), s = disk.origin(DiskMesh::previous(t));
    std::vector<Triangle> faces = mesh.faces;
    faces[h / 3] = {p, s, r};
    faces[t / 3] = {q, r, s};
    try {
      build_disk(mesh.positions, faces, Work(1));
    } catch (const Error&) {
      continue;  // the edge is there already
    }
    mesh.faces = std::move(faces);
  }
}

inline void collapse_some_positions(Random& random, meshes::TriangleList& mesh) {
  if (mesh.faces.size() < 12) return;  // some area must remain
  const int count = 1 + random.below(5);
  for (int i = 0; i < count; ++i) {
    const Triangle& t = mesh.faces[random.below(static_cast<int>(mesh.faces.size()))];
    mesh.positions[t[0]] = mesh.positions[t[random.below(2) + 1]];
  }
}

/// Numbers are drawn one by one: compilers take the arguments of a call in any order.
inline meshes::TriangleList random_base(Random& random) {
  switch (random.below(11)) {
    case 0:
      return meshes::triangle();
    case 1:
      return meshes::quad();
    case 2:
      return meshes::fan(3 + random.below(40));
    case 3:
      return meshes::strip(1 + random.below(60));
    case 4: {
      const int ny = 2 + random.below(20), nx = 2 + random.below(20);
      return meshes::bumps(nx, ny);
    }
    case 5: {
      const double angle = random.between(0.2, 3.1);
      const int sectors = 3 + random.below(30), rings = 2 + random.below(12);
      return meshes::cap(rings, sectors, angle);
    }
    case 6:
      return dumbbell(3 + random.below(7));
    case 7: {
      const double height = random.between(0.02, 2);
      const int sectors = 3 + random.below(14), rings = 2 + random.below(25);
      return tube(rings, sectors, height);
    }
    case 8: {
      const int across = 2 + random.below(5), along = 10 + random.below(40);
      return ramp(along, across);
    }
    case 9:
      return punctured(1 + random.below(3));
    default:
      return slit(2 + random.below(6));
  }
}

/// The same for a seed on every machine.
inline meshes::TriangleList random_disk(int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  meshes::TriangleList mesh = random_base(random);
  if (random.below(3) == 0) flip_edges(random, mesh);
  if (random.below(3) == 0) add_ears(random, mesh);
  if (random.below(2) == 0) add_noise(random, random.between(0, 0.8), mesh);
  if (random.below(3) == 0) scale_axes(random, 1000, mesh);
  if (random.below(4) == 0) add_spikes(random, mesh);
  if (random.below(8) == 0) collapse_some_positions(random, mesh);
  return mesh;
}

inline ChartOptions random_options(int seed) {
  Random random(static_cast<std::uint64_t>(seed) + 1000000);
  ChartOptions options;
  if (random.below(2) == 0) options.coarse_faces = 20 + random.below(200);
  if (random.below(3) == 0) {
    constexpr std::array<Flatten, 2> kFlattens = {Flatten::kDirichlet, Flatten::kGif};
    options.flatten = kFlattens[static_cast<std::size_t>(random.below(2))];
  }
  if (random.below(4) == 0) options.energy = Energy::kSymmetricArap;
  options.delaunay = random.below(6) == 0;
  options.unit_square = random.below(6) == 0;
  return options;
}

}  // namespace beltrami::disks
