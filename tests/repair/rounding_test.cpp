// Rounding to the numbers of a type without losing injectivity.
#include "repair/rounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/types.h"
#include "exact/certificate.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr Numbers kSingle = {.single = true};

Rounded round(const DiskMesh& mesh, const std::vector<Vec2>& uvs, int threads = 1) {
  return round_map(mesh, uvs, uvs, kSingle, Work(threads));
}

void expect_single_numbers(const Rounded& rounded) {
  for (const Vec2& w : rounded.uvs) {
    EXPECT_EQ(static_cast<double>(static_cast<float>(w.x())), w.x());
    EXPECT_EQ(static_cast<double>(static_cast<float>(w.y())), w.y());
  }
}

TEST(Rounding, IsTheNearestRoundingWhereThatIsInjective) {
  const DiskMesh mesh = disks::disk(meshes::grid(9, 9));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = w / 3 + Vec2(0.1, 0.7);
  const Rounded rounded = round(mesh, uvs);
  EXPECT_TRUE(rounded.certificate.injective());
  EXPECT_EQ(rounded.moved, 0);
  for (std::size_t v = 0; v < uvs.size(); ++v) EXPECT_EQ(rounded.uvs[v], kSingle.nearest(uvs[v]));
  expect_single_numbers(rounded);
}

TEST(Rounding, GoesToMultiplesOfAStep) {
  const DiskMesh mesh = disks::disk(meshes::grid(14, 14));
  const Numbers steps{.single = true, .step = 0x1p-6};
  EXPECT_EQ(steps.nearest(0.3), 0.296875);
  EXPECT_EQ(steps.nearest(-0.3), -0.296875);
  EXPECT_EQ(steps.spacing(1e-9), 0x1p-6);
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {w.x() + 0.01, w.y() * w.y() + 0.3 * w.x()};  // rows fold
  const Rounded rounded = round_map(mesh, uvs, uvs, steps, Work(1));
  EXPECT_TRUE(rounded.certificate.injective());
  EXPECT_GT(rounded.moved, 0);
  for (const Vec2& w : rounded.uvs) EXPECT_EQ(steps.nearest(w), w);
}

TEST(Rounding, OpensFacesThatRoundingFolds) {
  const DiskMesh mesh = disks::disk(meshes::grid(14, 14));
  for (const double height : {1e-6, 1e-7, 3e-8, 1e-9, 1e-12}) {
    // Rows squeezed to less than the spacing of floats around 1, slanted so that they fold.
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    for (Vec2& w : uvs) {
      const double bent = w.y() < 0.4 ? w.y() : w.y() > 0.6 ? w.y() - 0.2 + height : 0.4;
      const double t = std::clamp((w.y() - 0.4) / 0.2, 0.0, 1.0);
      w = {w.x(), 1 + bent + t * height + 0.3 * w.x()};
    }
    const Certificate exact = certify(mesh.faces, mesh.boundary, uvs, Work(1));
    if (!exact.injective()) continue;  // the squeeze is lost in double precision, too
    const Rounded rounded = round(mesh, uvs);
    EXPECT_TRUE(rounded.certificate.injective()) << height;
    expect_single_numbers(rounded);
    for (std::size_t v = 0; v < uvs.size(); ++v) {
      EXPECT_LT((rounded.uvs[v] - uvs[v]).norm(), 0.2) << height;
    }
  }
}

TEST(Rounding, KeepsBoundariesApartThatRoundingBringsTogether) {
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
    ASSERT_TRUE(certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective());
    const Rounded rounded = round(mesh, uvs);
    EXPECT_TRUE(rounded.certificate.injective()) << gap;
    expect_single_numbers(rounded);
  }
}

TEST(Rounding, LeavesWhatWasWrongBefore) {
  const DiskMesh mesh = disks::disk(meshes::grid(6, 6));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  uvs[24] += Vec2(0.4, 0.1);
  const Rounded rounded = round(mesh, uvs);
  EXPECT_FALSE(rounded.certificate.injective());
  EXPECT_EQ(rounded.moved, 0);
}

TEST(Rounding, SaysSoBeyondItsRange) {
  const DiskMesh mesh = disks::disk(meshes::triangle());
  const std::vector<Vec2> uvs = {{0, 0}, {1e300, 0}, {0, 1e300}};
  const Rounded rounded = round(mesh, uvs);
  for (const Vec2& w : rounded.uvs) EXPECT_TRUE(std::isfinite(static_cast<float>(w.x())));
  const std::vector<Vec2> far = {{1e300, 0}, {2e300, 0}, {1e300, 1e300}};
  EXPECT_FALSE(round(mesh, far).certificate.injective());
}

TEST(Rounding, KnowsTheNumbersOfATypeInAnotherUnit) {
  for (const int exponent : {0, 10, -10, 1030, -1000}) {
    const Numbers numbers = {.single = false, .exponent = exponent};
    for (const double x : {1.0, -1.0 / 3, 1e-9, 0.0}) {
      EXPECT_EQ(numbers.delivered(x), std::ldexp(x, -exponent));
      EXPECT_EQ(std::ldexp(numbers.delivered(x), exponent), numbers.nearest(x));
    }
  }
  const Numbers denormal = {.single = false, .exponent = 1030};
  EXPECT_NE(denormal.nearest(1.0 / 3), 1.0 / 3);
  EXPECT_EQ(denormal.spacing(1.0), 0x1p-44);
  EXPECT_EQ(kSingle.spacing(1.0), 0x1p-23);
  EXPECT_EQ((Numbers{.single = true, .exponent = 3}).nearest(0.1), 8 * kSingle.nearest(0.1 / 8));
}

TEST(Rounding, TellsWhatATypeCannotHold) {
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  EXPECT_TRUE((Numbers{.exponent = 1030}).hold(uvs, Work()));
  EXPECT_FALSE((Numbers{.exponent = 1080}).hold(uvs, Work()));
  EXPECT_FALSE((Numbers{.exponent = -1024}).hold(uvs, Work()));
  EXPECT_TRUE((Numbers{.single = true, .exponent = -127}).hold(uvs, Work()));
  EXPECT_FALSE((Numbers{.single = true, .exponent = -128}).hold(uvs, Work()));
  EXPECT_FALSE((Numbers{.single = true, .exponent = 160}).hold(uvs, Work()));
}

TEST(Rounding, AFaceLowerThanAStepGetsRoomBesideItsLine) {
  const DiskMesh mesh = disks::disk(meshes::triangle());
  const Numbers steps{.single = true, .step = 0x1p-24};
  const double y = 0.41220984;
  const std::vector<Vec2> uvs = {{0.28, y}, {0.31, y}, {0.29, y + 4e-9}};
  const Rounded rounded = round_map(mesh, uvs, uvs, steps, Work());
  EXPECT_TRUE(rounded.certificate.injective());
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    EXPECT_LE((rounded.uvs[v] - uvs[v]).cwiseAbs().maxCoeff(), 3 * steps.step);
  }
}

TEST(Rounding, OpensFacesThatPlacingFolds) {
  // Rows closer to each other than doubles around 1 are, but not than around 0.
  const DiskMesh mesh = disks::disk(meshes::grid(14, 14));
  for (const double height : {1e-15, 1e-16, 1e-17, 1e-25}) {
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    for (Vec2& w : uvs) w = {w.x(), w.y() < 0.3 ? height * w.y() : w.y()};
    ASSERT_TRUE(certify(mesh.faces, mesh.boundary, uvs, Work(1)).injective());
    std::vector<Vec2> placed = uvs;
    for (Vec2& w : placed) w += Vec2(0.7, 0.6 + 0.3 * w.x());
    const Rounded rounded = round_map(mesh, uvs, placed, {}, Work(1));
    EXPECT_TRUE(rounded.certificate.injective()) << height;
    EXPECT_GT(rounded.moved, 0) << height;
  }
}

// A vertex that placing puts a thousandth of an edge outside its kernel goes back about as far, not
// to the middle of what may be large faces.
TEST(Rounding, GoesNoFurtherIntoAKernelThanServes) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 4));
  const std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.on_boundary[v]) continue;
    const Index beside = mesh.target(mesh.outgoing[v]);
    std::vector<Vec2> placed = uvs;
    placed[v] = uvs[v] + 1.001 * (uvs[beside] - uvs[v]);
    const Rounded rounded = round_map(mesh, uvs, placed, kSingle, Work(1));
    EXPECT_TRUE(rounded.certificate.injective());
    EXPECT_LT((rounded.uvs[v] - placed[v]).norm(), 0.01 * (uvs[beside] - uvs[v]).norm());
  }
}

TEST(Rounding, HasTheSameBitsOnTwoThreads) {
  const DiskMesh mesh = disks::disk(meshes::grid(20, 20));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {w.x(), 4 + 2e-6 * w.y() + w.x()};
  EXPECT_EQ(round(mesh, uvs, 1).uvs, round(mesh, uvs, 2).uvs);
}

}  // namespace
}  // namespace beltrami
