// What docs/design/architecture.md promises: an energy is one small type. This one, the squared
// logarithmic strain (Hencky 1928), is no part of the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/portable_math.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/newton_loop.h"
#include "descend/newton_step.h"
#include "energy/density.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// 1/2 (log^2 s1 + log^2 s2), for s2 > 0.
struct Hencky {
  static constexpr bool kBarrier = true;

  static double value(double s1, double s2) {
    const double l1 = portable::log(s1), l2 = portable::log(s2);
    return 0.5 * (l1 * l1 + l2 * l2);
  }

  static DensityModel model(double s1, double s2) {
    const auto slope = [](double s) { return portable::log(s) / s; };
    const auto curvature = [](double s) { return std::max(0.0, (1 - portable::log(s)) / (s * s)); };
    DensityModel m;
    m.value = value(s1, s2);
    m.d1 = slope(s1);
    m.d2 = slope(s2);
    m.h11 = curvature(s1);
    m.h12 = 0;
    m.h22 = curvature(s2);
    m.twist = std::max(0.0, 2 * (m.d1 + m.d2) / (s1 + s2));
    m.flip = s1 > s2 ? std::max(0.0, 2 * (m.d1 - m.d2) / (s1 - s2)) : 2 * m.h11;
    return m;
  }
};

TEST(NewEnergy, TakesOneTypeToBeMinimised) {
  const DiskMesh mesh = disks::disk(meshes::grid(12, 12));
  const auto rest = disks::rest_of(mesh);
  std::vector<bool> fixed(mesh.vertex_count(), false);
  fixed[mesh.boundary.front()] = true;
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {1.7 * w.x() + 0.2 * w.x() * w.y(), 0.6 * w.y() - 0.1 * w.x() * w.x()};
  NewtonStepper<Hencky> stepper(mesh.faces, rest, fixed, Work(1));
  double energy = stepper.mean_energy(uvs);
  for (int i = 0; i < 30; ++i) {
    const NewtonStep step = stepper.step(uvs, energy);
    EXPECT_LE(step.energy, energy);
    energy = step.energy;
  }
  EXPECT_NEAR(energy, 0, 1e-12);
}

}  // namespace
}  // namespace beltrami
