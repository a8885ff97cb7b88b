// Nothing it cannot flatten: 500 disks that nobody chose.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "support/random_disks.h"

namespace beltrami {
namespace {

/// Ten seeds a test, so that they run side by side.
class RandomDisks : public testing::TestWithParam<int> {};

TEST_P(RandomDisks, EndInjective) {
  for (int seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    meshes::TriangleList mesh = disks::random_disk(seed);
    const Normalisation frame = normalise(mesh.positions, mesh.faces);
    const DiskMesh disk = disks::disk(std::move(mesh));
    const std::atomic<bool> cancelled{false};
    const Flattening result = flatten(disk, frame, disks::random_options(seed), {}, cancelled);
    EXPECT_TRUE(result.certificate.injective())
        << disk.face_count() << " faces, " << result.certificate.orientations.negative
        << " flipped, " << result.certificate.orientations.degenerate << " degenerate, "
        << result.certificate.crossings.count << " crossings";
    EXPECT_NE(result.status, BELTRAMI_NOT_INJECTIVE);
    EXPECT_TRUE(std::isfinite(result.distortion.symmetric_dirichlet));
    for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDisks, testing::Range(0, 50));

}  // namespace
}  // namespace beltrami
