// Our simplifier beside OpenMesh's decimater: the same kind of mesh, as near to the fine surface,
// and the same energy at the end. (What both have to keep: simplify_test.cpp.)
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/newton.h"
#include "descend/polish.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "flatten/dirichlet.h"
#include "flatten/metric.h"
#include "linear/spd_solver.h"
#include "mesh/closest_point.h"
#include "mesh/disk_mesh.h"
#include "prolong/prolongation.h"
#include "simplify/back_ends.h"
#include "simplify/coarse.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// A mesh and what both simplifiers leave of it.
struct Comparison {
  std::string name;
  DiskMesh fine;
  CoarseDisk ours = {}, openmesh = {};

  Comparison(std::string its_name, meshes::TriangleList mesh, Index target_faces)
      : name(std::move(its_name)), fine(disks::disk(std::move(mesh))) {
    ours = simplify_in_passes(fine, target_faces, Work(1));
    openmesh = simplify_by_openmesh(fine, target_faces, Work(1));
  }
};

/// Smooth, noisy, more than half a sphere, and with a bottleneck. All bend both ways: where there
/// is room for long triangles, ours keeps them even for the sake of the flattening, at some
/// distance.
std::vector<Comparison> comparisons() {
  meshes::TriangleList noisy = meshes::bumps(50, 50);
  disks::Random random(7);
  for (Vec3& p : noisy.positions) p += 0.004 * random.vec3();
  meshes::TriangleList dumbbell = disks::dumbbell(24);
  for (Vec3& p : dumbbell.positions)
    p.z() += 2 * portable::sin(0.3 * p.x()) * portable::cos(0.4 * p.y());
  std::vector<Comparison> all;
  all.emplace_back("bumps", meshes::bumps(60, 60), 700);
  all.emplace_back("noisy bumps", noisy, 500);
  all.emplace_back("cap", meshes::cap(40, 80, 2.2), 600);
  all.emplace_back("dumbbell", dumbbell, 300);
  return all;
}

Index euler_characteristic(const DiskMesh& mesh) {
  std::set<std::pair<Index, Index>> edges;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    edges.insert(std::minmax(mesh.origin(h), mesh.target(h)));
  }
  return mesh.vertex_count() - static_cast<Index>(edges.size()) + mesh.face_count();
}

TEST(Simplifiers, BothLeaveADiskOfTheSameSize) {
  for (const Comparison& both : comparisons()) {
    EXPECT_EQ(euler_characteristic(both.ours.mesh), 1) << both.name;
    EXPECT_EQ(euler_characteristic(both.openmesh.mesh), 1) << both.name;
    EXPECT_LT(both.ours.mesh.face_count(), both.fine.face_count() / 2) << both.name;
    EXPECT_NEAR(both.ours.mesh.face_count(), both.openmesh.mesh.face_count(), 2) << both.name;
  }
}

/// Mean of the squared distances from the fine vertices to the coarse surface.
double mean_squared_distance(const DiskMesh& fine, const CoarseDisk& coarse) {
  const ClosestPoint closest(coarse.mesh.positions, coarse.mesh.faces);
  double sum = 0;
  for (const Vec3& p : fine.positions) sum += closest.find(p, Vec3::Zero(), kNone).distance_sq;
  return sum / fine.vertex_count();
}

TEST(Simplifiers, OursStaysAboutAsNearToTheSurface) {
  for (const Comparison& both : comparisons()) {
    const double ours = mean_squared_distance(both.fine, both.ours);
    const double openmesh = mean_squared_distance(both.fine, both.openmesh);
    EXPECT_LE(ours, 1.5 * openmesh) << both.name;
  }
}

std::vector<bool> held(const DiskMesh& mesh) {
  return disks::only_fixed(mesh, mesh.boundary.front());
}

/// The minimum in the space of all maps.
std::vector<Vec2> flatten_coarse(const DiskMesh& mesh) {
  const auto rest = disks::rest_of(mesh);
  std::vector<Vec2> uvs = tutte_embedding(mesh, Work(1));
  minimise_energy(mesh.faces, rest, held(mesh), uvs, {}, Work(1));
  return uvs;
}

/// Mean energy of the fine map that the metric of the coarse one gives, polished.
double final_energy(const DiskMesh& fine, const CoarseDisk& coarse) {
  const std::vector<Vec2> coarse_uvs = flatten_coarse(coarse.mesh);
  const auto metric = prolong_metric(
      coarse.mesh, face_metrics(coarse.mesh.faces, disks::rest_of(coarse.mesh), coarse_uvs), fine,
      coarse.nearby, Work(1));
  const auto rest = disks::rest_of(fine);
  const auto stiffness = energy_stiffness(Energy::kSymmetricDirichlet, rest, metric, Work(1));
  MetricLaplacian laplacian(fine, stiffness, held(fine), {Precision::kSingle}, {}, Work(1));
  std::vector<Vec2> uvs = carry_boundary(fine, coarse, coarse_uvs);
  solve_metric(fine, rest, metric, stiffness, laplacian, {}, false, uvs, Work(1));
  EXPECT_TRUE(non_positive_faces(fine.faces, uvs, Work(1)).empty());
  const auto precondition = [&](const std::vector<Vec2>& in, std::vector<Vec2>& out) {
    laplacian.precondition(in, out);
  };
  return polish(fine, rest, precondition, uvs, {}, Work(1)).energies.back();
}

TEST(Simplifiers, BothLeadToTheSameEnergy) {
  for (const Comparison& both : comparisons()) {
    const double ours = final_energy(both.fine, both.ours);
    const double openmesh = final_energy(both.fine, both.openmesh);
    EXPECT_NEAR(ours / openmesh, 1, 0.001) << both.name;
  }
}

}  // namespace
}  // namespace beltrami
