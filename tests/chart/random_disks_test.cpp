// Nothing it cannot flatten: 800 disks that nobody chose.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "chart/flattening.h"
#include "support/random_disks.h"

#include "chart/flatten_disk.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;
using meshes::TriangleList;

/// Ten seeds a test, so that they run side by side.
class RandomDisks : public testing::TestWithParam<int> {};

TEST_P(RandomDisks, EndInjective) {
  for (int seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TriangleList mesh = disks::random_disk(seed);
    const Normalisation frame = normalise(mesh.positions, mesh.faces, Work(1));
    const DiskMesh disk = disks::disk(std::move(mesh));
    const Flattening result = flatten(disk, frame, disks::random_options(seed), Work());
    EXPECT_TRUE(result.certificate.injective())
        << disk.face_count() << " faces, " << result.certificate.orientations.negative
        << " flipped, " << result.certificate.orientations.degenerate << " degenerate, "
        << result.certificate.crossings.count << " crossings";
    EXPECT_NE(result.status, Outcome::kNotInjective);
    EXPECT_TRUE(std::isfinite(result.distortion.symmetric_dirichlet));
    for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDisks, testing::Range(0, 50));

// ---- Everything at its extreme, through every method -----------------------------------------

double power_of_ten(double exponent) {
  return portable::exp(std::numbers::ln10 * exponent);
}

void scale_coordinates(Random& random, double decades, int one_in, TriangleList& mesh) {
  for (Vec3& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      if (random.below(one_in) == 0) p[k] *= power_of_ten(random.between(-decades, decades));
    }
  }
}

void scale_to_an_end_of_the_range(Random& random, TriangleList& mesh) {
  double greatest = 0;
  for (const Vec3& p : mesh.positions) greatest = std::max(greatest, p.cwiseAbs().maxCoeff());
  const double target = random.below(2) == 0 ? 1e-308 : 1e302;
  for (Vec3& p : mesh.positions) p = p / greatest * target;
}

TriangleList extreme_disk(int seed, Random& random) {
  TriangleList mesh = disks::random_disk(seed);
  if (random.below(3) == 0) scale_coordinates(random, 20, 4, mesh);
  if (random.below(12) == 0) scale_coordinates(random, 250, 3, mesh);
  if (random.below(6) == 0) {
    const double flat = power_of_ten(-random.between(3, 14));
    for (Vec3& p : mesh.positions) p.y() *= flat;
  }
  if (random.below(6) == 0) {
    const Vec3 direction = random.vec3();
    const Vec3 offset = power_of_ten(random.between(0, 12)) * direction;
    for (Vec3& p : mesh.positions) p += offset;
  }
  if (random.below(6) == 0) scale_to_an_end_of_the_range(random, mesh);
  if (random.below(4) == 0) {
    const double unit = random.below(2) == 0 ? std::ldexp(1.0, random.below(80) - 40)
                                             : power_of_ten(random.between(-12, 12));
    for (Vec3& p : mesh.positions) p = (unit * p).cwiseMax(-1e307).cwiseMin(1e307);
  }
  return mesh;
}

ChartOptions extreme_options(Random& random) {
  ChartOptions options;
  if (random.below(3) > 0) options.coarse_faces = 4 + random.below(random.below(2) == 0 ? 20 : 300);
  options.method = static_cast<Method>(std::max(0, random.below(10) - 4));
  if (random.below(2) == 0) options.flatten = static_cast<Flatten>(random.below(5));
  options.energy =
      std::array{Energy::kSymmetricDirichlet, Energy::kSymmetricDirichlet, Energy::kSymmetricArap,
                 Energy::kExponentialDirichlet}[random.below(4)];
  if (random.below(3) == 0) options.injectivity = static_cast<Injectivity>(random.below(3));
  options.delaunay = random.below(6) == 0;
  options.unit_square = random.below(4) == 0;
  options.float32 = random.below(3) == 0;
  options.refine = random.below(8) == 0;
  return options;
}

/// Whether the mode promises an injective map in the numbers that were asked for.
bool promises_injective(const ChartOptions& options) {
  if (options.injectivity == Injectivity::kLocal) return false;
  if (options.method == Method::kTutte) return !options.float32;
  return promises(options);
}

class ExtremeDisks : public testing::TestWithParam<int> {};

TEST_P(ExtremeDisks, EndWithAMapAndATruthfulStatus) {
  for (int seed = 10 * GetParam(); seed < 10 * GetParam() + 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed) + 2000000);
    TriangleList mesh = extreme_disk(seed, random);
    const ChartOptions options = extreme_options(random);
    Normalisation frame;
    try {
      frame = normalise(mesh.positions, mesh.faces, Work(1));
    } catch (const Error&) {
      continue;  // no area is left
    }
    const DiskMesh disk = disks::disk(std::move(mesh));
    const Flattening result = flatten(disk, frame, options, Work());
    for (const Vec2& w : result.uvs) ASSERT_TRUE(w.allFinite());
    const auto& faces = result.faces.empty() ? disk.faces : result.faces;
    const bool injective = certify(faces, disk.boundary, result.uvs, Work(1)).injective();
    EXPECT_EQ(injective, result.certificate.injective());
    // Beyond the range of the type a map is not what was asked for even where it is injective.
    EXPECT_TRUE(injective || result.status >= Outcome::kNotInjective);
    const bool beyond_floats =
        options.float32 && !options.unit_square && std::abs(frame.exponent) > 90;
    EXPECT_TRUE(injective || beyond_floats || !promises_injective(options));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ExtremeDisks, testing::Range(0, 30));

}  // namespace
}  // namespace beltrami
