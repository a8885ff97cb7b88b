#include "mesh/vertex_sums.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/lanes.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// What corner k of a face gives: small whole numbers, whose sums are exact.
Vec2 term(Index f, int k) {
  return {static_cast<double>(f % 13 - 6), static_cast<double>((f + k) % 7)};
}

std::vector<Vec2> one_by_one(const DiskMesh& mesh, int threads) {
  std::vector<Vec2> sums;
  VertexSums(mesh.vertex_count(), mesh.faces, Work(threads))
      .add_up(
          [](Index f, VertexSums::Terms& terms) {
            for (int k = 0; k < 3; ++k) terms[k] = term(f, k);
            return 0.0;
          },
          sums);
  return sums;
}

std::vector<Vec2> in_lanes(const DiskMesh& mesh, int threads) {
  std::vector<Vec2> sums;
  VertexSums(mesh.vertex_count(), mesh.faces, Work(threads))
      .add_up_lanes(
          [](const std::array<Index, kLanes>& faces, VertexSums::LaneTerms& terms) {
            for (int k = 0; k < 3; ++k) {
              for (int i = 0; i < kLanes; ++i) {
                terms[k].real[i] = static_cast<float>(term(faces[i], k).x());
                terms[k].imag[i] = static_cast<float>(term(faces[i], k).y());
              }
            }
          },
          sums);
  return sums;
}

// Face counts that lanes and chunks divide, and that they do not.
TEST(VertexSums, InLanesAreThoseOneByOne) {
  for (const int n : {1, 2, 5, 64, 67}) {
    const DiskMesh mesh = disks::disk(meshes::grid(n, 3 * n));
    const std::vector<Vec2> expected = one_by_one(mesh, 1);
    EXPECT_EQ(in_lanes(mesh, 1), expected) << n;
    EXPECT_EQ(in_lanes(mesh, 2), expected) << n;
    EXPECT_EQ(one_by_one(mesh, 2), expected) << n;
  }
}

}  // namespace
}  // namespace beltrami
