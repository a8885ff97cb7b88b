// Spikes: faces so distorted that no step of the whole map makes sense.
#include "repair/spikes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "support/disks.h"
#include "support/energies.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kLimit = 60;

/// A flat grid with a few vertices that were pushed to an edge of a face at them, nearly.
struct Spiky {
  explicit Spiky(double near) {
    for (const Index row : {10, 25, 31}) {
      const Index v = row * (kSide + 1) + 20;
      const Vec2 across = uvs[v + 1] - uvs[v];
      uvs[v] += (1 - near) * across;
    }
  }

  double mean(Energy energy) const { return mean_energy(energy, mesh.faces, rest, uvs, Work(1)); }
  bool positive() const { return non_positive_faces(mesh.faces, uvs, Work(1)).empty(); }

  static constexpr int kSide = 40;
  DiskMesh mesh = disks::disk(meshes::grid(kSide, kSide));
  std::vector<RestTriangle> rest = disks::rest_of(mesh);
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
};

// The Newton systems of regions are lost to rounding at energies of 1e26, those of a vertex are
// not.
TEST(Spikes, AreGoneWhateverTheirEnergyAndNothingElseMoves) {
  for (const Energy energy : {Energy::kSymmetricDirichlet, Energy::kSymmetricArap}) {
    for (const double near : {1e-2, 1e-6, 1e-13}) {
      Spiky map(near);
      ASSERT_TRUE(map.positive());
      const std::vector<Vec2> flat = disks::flat_uvs(map.mesh);
      const double flat_mean = mean_energy(energy, map.mesh.faces, map.rest, flat, Work(1));
      EXPECT_GE(relax_spikes(energy, kLimit, map.mesh, map.rest, map.uvs, Work(1)), 3U);
      EXPECT_TRUE(map.positive());
      EXPECT_LT(map.mean(energy), flat_mean + 0.05);
      EXPECT_EQ(relax_spikes(energy, kLimit, map.mesh, map.rest, map.uvs, Work(1)), 0U) << near;
      EXPECT_EQ(map.uvs.front(), flat.front());
      EXPECT_EQ(map.uvs.back(), flat.back());
    }
  }
}

// Where rounding decides, the exact predicates may see a positive face where floats see none: its
// energy is infinite, and no step leads away from it.
TEST(Spikes, AreGoneWhereOnlyExactPredicatesSeeAPositiveFace) {
  Spiky map(1);
  for (Vec2& p : map.uvs) p = Vec2(0.8 * p.x() - 0.6 * p.y(), 0.6 * p.x() + 0.8 * p.y()) / 3;
  const Index v = 20 * (Spiky::kSide + 1) + 20;
  const Index side = Surface::next(map.mesh.outgoing[v]);  // of a face, opposite of the vertex
  const Vec2 a = map.uvs[map.mesh.origin(side)], b = map.uvs[map.mesh.target(side)];
  bool found = false;
  for (int i = 1; i < 1000 && !found; ++i) {
    map.uvs[v] = a + i / 1000.0 * (b - a);
    found = map.positive() && !std::isfinite(map.mean(Energy::kSymmetricDirichlet));
  }
  ASSERT_TRUE(found);
  EXPECT_GE(relax_spikes(Energy::kSymmetricDirichlet, kLimit, map.mesh, map.rest, map.uvs, Work(1)),
            1U);
  EXPECT_TRUE(map.positive());
  EXPECT_LT(map.mean(Energy::kSymmetricDirichlet), kLimit);
}

TEST(Spikes, HaveTheSameBitsOnTwoThreads) {
  Spiky one(1e-6), two(1e-6);
  relax_spikes(Energy::kSymmetricDirichlet, kLimit, one.mesh, one.rest, one.uvs, Work(1));
  relax_spikes(Energy::kSymmetricDirichlet, kLimit, two.mesh, two.rest, two.uvs, Work(2));
  EXPECT_EQ(one.uvs, two.uvs);
}

TEST(Spikes, AreLookedForOnlyAboveTheLimit) {
  Spiky map(0.5);
  const std::vector<Vec2> before = map.uvs;
  EXPECT_EQ(relax_spikes(Energy::kSymmetricDirichlet, kLimit, map.mesh, map.rest, map.uvs, Work(1)),
            0U);
  EXPECT_EQ(map.uvs, before);
}

}  // namespace
}  // namespace beltrami
