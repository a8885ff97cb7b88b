// The factor of an energy's Hessian against the steps of composite majorization, which solve with
// it.
#include "flatten/hessian_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "descend/newton.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "mesh/boundary.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

double dot(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// A bumpy disk near the minimum of an energy.
struct NearMinimum {
  explicit NearMinimum(Energy which) : energy(which) {
    NewtonOptions newton;
    newton.energy = energy;
    newton.tolerance = 1e-3;
    minimise_energy(mesh.faces, rest, only_first_of_boundary(mesh), uvs, newton, Work(1));
  }

  double mean() const { return mean_energy(energy, mesh.faces, rest, uvs, Work(1)); }

  /// Of the mean energy, by differences.
  std::vector<Vec2> gradient() {
    constexpr double kStep = 1e-6;
    std::vector<Vec2> result(uvs.size());
    for (std::size_t v = 0; v < uvs.size(); ++v) {
      for (int k = 0; k < 2; ++k) {
        const double at = uvs[v][k];
        uvs[v][k] = at + kStep;
        const double above = mean();
        uvs[v][k] = at - kStep;
        result[v][k] = (above - mean()) / (2 * kStep);
        uvs[v][k] = at;
      }
    }
    return result;
  }

  Energy energy;
  DiskMesh mesh = disks::disk(meshes::bumps(12, 12));
  std::vector<RestTriangle> rest = disks::rest_of(mesh);
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
};

std::vector<Vec2> random_field(std::size_t size, int seed) {
  disks::Random random(seed);
  std::vector<Vec2> field;
  for (std::size_t v = 0; v < size; ++v) field.push_back(random.vec2());
  return field;
}

TEST(HessianFactor, TakesTheStepOfCompositeMajorization) {
  for (const Energy energy : {Energy::kSymmetricDirichlet, Energy::kExponentialDirichlet}) {
    NearMinimum at(energy);
    HessianFactor factor(at.mesh, Work(1));
    ASSERT_TRUE(factor.fit(energy, at.rest, at.uvs));
    const double area = surface_area(at.mesh, Work(1));
    std::vector<Vec2> force = at.gradient(), step;
    for (Vec2& f : force) f *= -area;
    factor.precondition(force, step);
    const std::vector<Vec2> from = at.uvs;
    NewtonOptions newton;
    newton.energy = energy;
    newton.proxy_steps = 0;
    newton.max_iterations = 1;
    const NewtonResult done = minimise_energy(
        at.mesh.faces, at.rest, only_first_of_boundary(at.mesh), at.uvs, newton, Work(1));
    ASSERT_EQ(done.iterations(), 1);
    double apart = 0, size = 0;
    for (std::size_t v = 0; v < from.size(); ++v) {
      apart += (at.uvs[v] - from[v] - step[v]).squaredNorm();
      size += step[v].squaredNorm();
    }
    EXPECT_LE(std::sqrt(apart), 0.02 * std::sqrt(size)) << static_cast<int>(energy);
  }
}

TEST(HessianFactor, IsSymmetricAndDefinite) {
  const NearMinimum at(Energy::kSymmetricDirichlet);
  HessianFactor factor(at.mesh, Work(1));
  ASSERT_TRUE(factor.fit(at.energy, at.rest, at.uvs));
  const std::vector<Vec2> a = random_field(at.uvs.size(), 5), b = random_field(at.uvs.size(), 8);
  std::vector<Vec2> of_a, of_b;
  factor.precondition(a, of_a);
  factor.precondition(b, of_b);
  EXPECT_GT(dot(a, of_a), 0);
  EXPECT_GT(dot(b, of_b), 0);
  EXPECT_NEAR(dot(of_a, b), dot(a, of_b), 1e-4 * std::sqrt(dot(a, of_a) * dot(b, of_b)));
}

TEST(HessianFactor, StaysWhatItIsOnceSettledAndFitsAgain) {
  const NearMinimum at(Energy::kSymmetricDirichlet);
  HessianFactor factor(at.mesh, Work(1));
  ASSERT_TRUE(factor.fit(at.energy, at.rest, at.uvs));
  const std::vector<Vec2> rhs = random_field(at.uvs.size(), 6);
  std::vector<Vec2> before, settled, again;
  factor.precondition(rhs, before);
  factor.settle();
  factor.precondition(rhs, settled);
  EXPECT_EQ(settled, before);
  ASSERT_TRUE(factor.fit(at.energy, at.rest, at.uvs));
  factor.precondition(rhs, again);
  EXPECT_EQ(again, before);
}

TEST(HessianFactor, FitsAgainAsItWouldAnew) {
  const NearMinimum at(Energy::kSymmetricDirichlet);
  HessianFactor again(at.mesh, Work(1)), anew(at.mesh, Work(1));
  ASSERT_TRUE(again.fit(at.energy, at.rest, disks::flat_uvs(at.mesh)));
  ASSERT_TRUE(again.fit(at.energy, at.rest, at.uvs));
  ASSERT_TRUE(anew.fit(at.energy, at.rest, at.uvs));
  const std::vector<Vec2> rhs = random_field(at.uvs.size(), 7);
  std::vector<Vec2> of_again, of_anew;
  again.precondition(rhs, of_again);
  anew.precondition(rhs, of_anew);
  double apart = 0, size = 0;  // the order of the unknowns is that of the first map
  for (std::size_t v = 0; v < rhs.size(); ++v) {
    apart += (of_again[v] - of_anew[v]).squaredNorm();
    size += of_anew[v].squaredNorm();
  }
  EXPECT_LE(std::sqrt(apart), 1e-3 * std::sqrt(size));
}

}  // namespace
}  // namespace beltrami
