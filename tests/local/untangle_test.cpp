// Untangling of a patch as a whole.
#include "local/untangle.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/types.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;

/// A grid of n by n whose boundary stays.
struct Tangle {
  explicit Tangle(Index n) : mesh(disks::disk(meshes::grid(n, n))), fixed(mesh.on_boundary) {
    uvs = disks::flat_uvs(mesh);
  }

  bool untangle() {
    return beltrami::untangle(mesh.faces, disks::rest_of(mesh), fixed, uvs, Work(1));
  }
  bool positive() const { return non_positive_faces(mesh.faces, uvs, Work(1)).empty(); }

  DiskMesh mesh;
  std::vector<bool> fixed;
  std::vector<Vec2> uvs;
};

TEST(Untangle, EndsPositiveOrChangesNothing) {
  Random random(7);
  int untangled = 0, left = 0;
  for (int i = 0; i < 200; ++i) {
    const Index n = 2 + i % 4;
    Tangle tangle(n);
    const double on_boundary = 0.4 * (i % 3) / n, inside = 0.2 + 0.3 * (i % 5);
    for (std::size_t v = 0; v < tangle.uvs.size(); ++v) {
      tangle.uvs[v] += (tangle.fixed[v] ? on_boundary : inside) * random.vec2();
    }
    const std::vector<Vec2> before = tangle.uvs;
    const bool done = tangle.untangle();
    ++(done ? untangled : left);
    EXPECT_EQ(done, tangle.positive());
    for (std::size_t v = 0; v < before.size(); ++v) {
      if (!done || tangle.fixed[v]) {
        EXPECT_EQ(tangle.uvs[v], before[v]);
      }
    }
  }
  EXPECT_GT(untangled, 100);
  EXPECT_GT(left, 0);
}

// Its faces came to rest flipped by less than the barrier was softened.
TEST(Untangle, TightensWhereFacesComeToRestFlipped) {
  constexpr std::array<double, 16> kHeights = {.19, 0,    .27, -.03, -.36, .08,  -.33, -.25,
                                               .1,  -.18, .29, .14,  .07,  -.04, .18,  -.02};
  Tangle tangle(3);
  for (std::size_t v = 0; v < kHeights.size(); ++v) {
    const std::size_t row = v / 4;
    tangle.mesh.positions[v] = {static_cast<double>(v % 4), static_cast<double>(row), kHeights[v]};
  }
  tangle.uvs = {{-.16, .26},  {.92, .25},   {1.6, -.01},  {2.79, .55}, {-.1, 1.58}, {-.51, -.58},
                {.55, -1.15}, {2.96, 1.32}, {-.08, 1.47}, {-.24, .23}, {.44, 2.06}, {2.61, 2.58},
                {-.48, 3.54}, {1.24, 2.87}, {2.02, 2.84}, {2.97, 2.8}};
  EXPECT_TRUE(tangle.untangle());
  EXPECT_TRUE(tangle.positive());
}

}  // namespace
}  // namespace beltrami
