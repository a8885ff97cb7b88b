// Rounding to single precision without losing injectivity.
#include "repair/single_precision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exact/certificate.h"
#include "support/disks.h"

namespace beltrami {
namespace {

using disks::Random;

SinglePrecision round(const DiskMesh& mesh, const std::vector<Vec2>& uvs, int threads = 1) {
  return round_to_single(mesh, uvs, certify(mesh.faces, mesh.boundary, uvs, 1), threads);
}

void expect_single_numbers(const SinglePrecision& rounded) {
  for (const Vec2& w : rounded.uvs) {
    EXPECT_EQ(static_cast<double>(static_cast<float>(w.x())), w.x());
    EXPECT_EQ(static_cast<double>(static_cast<float>(w.y())), w.y());
  }
}

TEST(SinglePrecision, IsTheNearestRoundingWhereThatIsInjective) {
  const DiskMesh mesh = disks::disk(meshes::grid(9, 9));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = w / 3 + Vec2(0.1, 0.7);
  const SinglePrecision rounded = round(mesh, uvs);
  EXPECT_TRUE(rounded.certificate.injective());
  EXPECT_EQ(rounded.moved, 0);
  for (std::size_t v = 0; v < uvs.size(); ++v) EXPECT_EQ(rounded.uvs[v], nearest_single(uvs[v]));
  expect_single_numbers(rounded);
}

TEST(SinglePrecision, OpensFacesThatRoundingFolds) {
  const DiskMesh mesh = disks::disk(meshes::grid(14, 14));
  for (const double height : {1e-6, 1e-7, 3e-8, 1e-9, 1e-12}) {
    // Rows squeezed to less than the spacing of floats around 1, slanted so that they fold.
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    for (Vec2& w : uvs) {
      const double bent = w.y() < 0.4 ? w.y() : w.y() > 0.6 ? w.y() - 0.2 + height : 0.4;
      const double t = std::clamp((w.y() - 0.4) / 0.2, 0.0, 1.0);
      w = {w.x(), 1 + bent + t * height + 0.3 * w.x()};
    }
    const Certificate exact = certify(mesh.faces, mesh.boundary, uvs, 1);
    if (!exact.injective()) continue;  // the squeeze is lost in double precision, too
    const SinglePrecision rounded = round(mesh, uvs);
    EXPECT_TRUE(rounded.certificate.injective()) << height;
    expect_single_numbers(rounded);
    for (std::size_t v = 0; v < uvs.size(); ++v) {
      EXPECT_LT((rounded.uvs[v] - uvs[v]).norm(), 0.2) << height;
    }
  }
}

TEST(SinglePrecision, KeepsBoundariesApartThatRoundingBringsTogether) {
  // The two sides of a slit, a little ajar.
  const Index n = 8;
  const DiskMesh mesh = disks::disk(disks::slit(n));
  for (const double gap : {1e-6, 1e-7, 1e-8, 1e-10}) {
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    const Index first_upper = (2 * n + 1) * (2 * n + 1);
    for (Index v = first_upper; v < mesh.vertex_count(); ++v) {
      uvs[v].y() += gap * (1 + v - first_upper);
    }
    for (Vec2& w : uvs) w = {w.x() + 0.377 * w.y(), 0.61 * w.y() - 0.33 * w.x() + 0.7};
    ASSERT_TRUE(certify(mesh.faces, mesh.boundary, uvs, 1).injective());
    const SinglePrecision rounded = round(mesh, uvs);
    EXPECT_TRUE(rounded.certificate.injective()) << gap;
    expect_single_numbers(rounded);
  }
}

TEST(SinglePrecision, LeavesWhatWasWrongBefore) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[24] += Vec2(0.4, 0.1);
  const SinglePrecision rounded = round(mesh, uvs);
  EXPECT_FALSE(rounded.certificate.injective());
  EXPECT_EQ(rounded.moved, 0);
}

TEST(SinglePrecision, SaysSoBeyondItsRange) {
  const DiskMesh mesh = disks::disk(meshes::triangle());
  const std::vector<Vec2> uvs = {{0, 0}, {1e300, 0}, {0, 1e300}};
  const SinglePrecision rounded = round(mesh, uvs);
  for (const Vec2& w : rounded.uvs) EXPECT_TRUE(std::isfinite(static_cast<float>(w.x())));
  const std::vector<Vec2> far = {{1e300, 0}, {2e300, 0}, {1e300, 1e300}};
  EXPECT_FALSE(round(mesh, far).certificate.injective());
}

TEST(SinglePrecision, HasTheSameBitsOnTwoThreads) {
  const DiskMesh mesh = disks::disk(meshes::grid(20, 20));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {w.x(), 4 + 2e-6 * w.y() + w.x()};
  EXPECT_EQ(round(mesh, uvs, 1).uvs, round(mesh, uvs, 2).uvs);
}

}  // namespace
}  // namespace beltrami
