// Spikes: faces so distorted that no step of the whole map makes sense.
#include "repair/spikes.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/work.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
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
