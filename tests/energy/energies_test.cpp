// Energy densities against finite differences, and the measure of a given map.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/assembly.h"
#include "energy/density.h"
#include "energy/measure.h"
#include "energy/symmetric_arap.h"
#include "energy/symmetric_dirichlet.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "support/disks.h"
#include "support/face_maps.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;
using faces::corners_of;
using faces::energy_of;
using faces::hessian_by_differences;
using faces::least_eigenvalue;
using faces::map_of;
using faces::model_of;

TEST(FaceModels, AreThoseOfEachFaceAlone) {
  std::vector<Triangle> faces;
  std::vector<RestTriangle> rest;
  std::vector<Vec2> uvs;
  // More than a block, among them one that is conformal and one that has shrunk to a point.
  for (int f = 0; f < FaceModels::kFaces + 3; ++f) {
    const double s1 = f == 4 ? 0 : 1 + 0.1 * f, s2 = f == 2 ? s1 : f == 4 ? 0 : 0.9 - 0.03 * f;
    const Vector6 x = corners_of(s1, s2);
    const auto first = static_cast<Index>(uvs.size());
    faces.push_back({first, first + 1, first + 2});
    rest.push_back(faces::kRest);
    for (int k = 0; k < 3; ++k) uvs.emplace_back(x.segment<2>(2 * k));
  }
  const auto weight = [](std::int64_t f) { return 1.0 + static_cast<double>(f); };
  const SymmetricArap::Proxy density;
  const std::int64_t count = size_of(faces);
  for (std::int64_t first = 0; first < count; first += FaceModels::kFaces) {
    FaceModels together, alone;
    give_face_models(faces, rest, uvs, first, count, density, weight, together);
    for (std::int64_t f = first; f < std::min(count, first + FaceModels::kFaces); ++f) {
      give_face_models(faces, rest, uvs, f, f + 1, density, weight, alone);
      const FaceModel one = together.at(static_cast<int>(f - first)), other = alone.at(0);
      if (f == 4) continue;  // no density is finite there
      EXPECT_EQ(one.gradient, other.gradient) << f;
      EXPECT_EQ(one.hessian, other.hessian) << f;
      EXPECT_TRUE(one.hessian.allFinite()) << f;
    }
  }
}

// ---- The density in its singular values -----------------------------------------------------

class DensityAt : public testing::TestWithParam<std::pair<double, double>> {
 protected:
  const double s1 = GetParam().first, s2 = GetParam().second;
};

TEST_P(DensityAt, HasTheGradientOfItsValue) {
  const auto value = SymmetricDirichlet::value;
  const DensityModel m = SymmetricDirichlet::model(s1, s2);
  const double h1 = 1e-6 * s1, h2 = 1e-6 * s2;
  const double scale = std::max(std::abs(m.d1), std::abs(m.d2)) + m.value;
  EXPECT_DOUBLE_EQ(m.value, value(s1, s2));
  EXPECT_NEAR(m.d1, (value(s1 + h1, s2) - value(s1 - h1, s2)) / (2 * h1), 1e-8 * scale);
  EXPECT_NEAR(m.d2, (value(s1, s2 + h2) - value(s1, s2 - h2)) / (2 * h2), 1e-8 * scale);
}

TEST_P(DensityAt, HasTheRadialHessianOfItsValue) {
  const auto model = SymmetricDirichlet::model;
  const DensityModel m = model(s1, s2);
  const double h1 = 1e-5 * s1, h2 = 1e-5 * s2, scale = std::max(m.h11, m.h22);
  EXPECT_NEAR(m.h11, (model(s1 + h1, s2).d1 - model(s1 - h1, s2).d1) / (2 * h1), 1e-8 * scale);
  EXPECT_NEAR(m.h22, (model(s1, s2 + h2).d2 - model(s1, s2 - h2).d2) / (2 * h2), 1e-8 * scale);
  EXPECT_NEAR(m.h12, (model(s1, s2 + h2).d1 - model(s1, s2 - h2).d1) / (2 * h2), 1e-8 * scale);
}

// ---- The density in the six coordinates of a face -------------------------------------------

TEST_P(DensityAt, HasTheFaceGradientOfItsEnergy) {
  const Vector6 x = corners_of(s1, s2);
  const Vector6 gradient = model_of(x, SymmetricDirichlet{}).gradient;
  const double h = 1e-5 * s2;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = h * Vector6::Unit(i);
    EXPECT_NEAR(
        gradient[i],
        (energy_of<SymmetricDirichlet>(x + step) - energy_of<SymmetricDirichlet>(x - step)) /
            (2 * h),
        1e-7 * (gradient.norm() + energy_of<SymmetricDirichlet>(x)))
        << i;
  }
}

TEST_P(DensityAt, HasTheFaceHessianOfItsEnergyButForTheClampedTwist) {
  const Vector6 x = corners_of(s1, s2);
  const Matrix6 modelled = model_of(x, SymmetricDirichlet{}).hessian;
  const Matrix6 true_hessian = hessian_by_differences<SymmetricDirichlet>(x, 1e-5 * s2);
  const double tolerance = 1e-6 * modelled.norm();
  EXPECT_GE(least_eigenvalue(modelled), -1e-12 * modelled.norm());
  // What the clamp adds is positive semi-definite, and nothing where the twist is not negative.
  EXPECT_GE(least_eigenvalue(modelled - true_hessian), -tolerance);
  const DensityModel m = SymmetricDirichlet::model(s1, s2);
  if (m.d1 + m.d2 >= 0) {
    EXPECT_LE((modelled - true_hessian).norm(), tolerance);
  }
}

TEST_P(DensityAt, ClampsTheTwistAndNothingElse) {
  const DensityModel m = SymmetricDirichlet::model(s1, s2);
  const double twist = 2 * (m.d1 + m.d2) / (s1 + s2);
  EXPECT_DOUBLE_EQ(m.twist, std::max(0.0, twist));
  EXPECT_GT(m.flip, 0);
  EXPECT_GT(m.h11, 0);
  EXPECT_GT(m.h22, 0);
  const Vector6 x = corners_of(s1, s2);
  const Matrix6 clamped = model_of(x, SymmetricDirichlet{}).hessian -
                          hessian_by_differences<SymmetricDirichlet>(x, 1e-5 * s2);
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Matrix6>(clamped).eigenvalues();
  // At most one direction of the matrix space is changed.
  EXPECT_LE(values[4], 1e-6 * model_of(x, SymmetricDirichlet{}).hessian.norm());
}

TEST_P(DensityAt, HasAProxyOfTheSameValueAndGradientWithAPositiveHessian) {
  const DensityModel exact = SymmetricDirichlet::model(s1, s2);
  const DensityModel proxy = SymmetricDirichlet::Proxy::model(s1, s2);
  EXPECT_EQ(proxy.value, exact.value);
  EXPECT_LE(std::abs(proxy.coupling), std::sqrt(proxy.twist * proxy.flip));
  const Vector6 x = corners_of(s1, s2);
  const FaceModel model = model_of(x, SymmetricDirichlet::Proxy{});
  EXPECT_EQ(model.gradient, model_of(x, SymmetricDirichlet{}).gradient);
  EXPECT_GE(least_eigenvalue(model.hessian), -1e-12 * model.hessian.norm());
}

// H (x - rotation) = gradient: the model's minimum is the closest rotation of the rest triangle.
TEST_P(DensityAt, HasAProxyWhoseMinimumIsTheClosestRotation) {
  const Vector6 x = corners_of(s1, s2);
  const Complex fz = map_of(x).fz;
  Vector6 rotated;
  for (int k = 0; k < 3; ++k) {
    const Complex w = fz / std::abs(fz) * faces::kRest.corner(k);
    rotated.segment<2>(2 * k) << w.real(), w.imag();
  }
  const FaceModel model = model_of(x, SymmetricDirichlet::Proxy{});
  const Vector6 product = model.hessian * (x - rotated);
  EXPECT_LE((product - model.gradient).norm(), 1e-9 * (1 + model.hessian.norm()));
}

INSTANTIATE_TEST_SUITE_P(SingularValues, DensityAt,
                         testing::Values(std::pair(3.0, 2.0), std::pair(2.0, 2.0),
                                         std::pair(1.0, 1.0), std::pair(1.0, 0.5),
                                         std::pair(0.1, 0.01), std::pair(50.0, 0.02)));

TEST(SymmetricDirichlet, IsLeastAtAnIsometry) {
  EXPECT_EQ(SymmetricDirichlet::value(1, 1), 2);
  EXPECT_EQ(SymmetricDirichlet::model(1, 1).d1, 0);
  EXPECT_EQ(SymmetricDirichlet::model(1, 1).d2, 0);
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_GE(SymmetricDirichlet::value(random.between(0.1, 5), random.between(0.1, 5)), 2);
  }
}

TEST_P(DensityAt, HasSlopesThatAreItsGradientByFzAndFzbar) {
  const DensityModel m = SymmetricDirichlet::model(s1, s2);
  const LinearMap map = map_of(corners_of(s1, s2));
  const DensitySlopes slopes = SymmetricDirichlet::slopes(map);
  const double scale = 1e-9 * (std::abs(m.d1) + std::abs(m.d2) + m.value);
  EXPECT_NEAR(slopes.value, m.value, scale);
  EXPECT_NEAR(slopes.by_fz * std::abs(map.fz), m.d1 + m.d2, scale);
  EXPECT_NEAR(slopes.by_fzbar * std::abs(map.fzbar), m.d1 - m.d2, scale);
}

// ---- Symmetric ARAP, which has a ridge at s1 = s2 -------------------------------------------

class ArapAt : public DensityAt {};

TEST_P(ArapAt, HasTheFaceGradientOfItsEnergy) {
  const Vector6 x = corners_of(s1, s2);
  const Vector6 gradient = model_of(x, SymmetricArap{}).gradient;
  const double h = 1e-5 * s2;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = h * Vector6::Unit(i);
    EXPECT_NEAR(gradient[i],
                (energy_of<SymmetricArap>(x + step) - energy_of<SymmetricArap>(x - step)) / (2 * h),
                1e-7 * (gradient.norm() + energy_of<SymmetricArap>(x)))
        << i;
  }
}

TEST_P(ArapAt, HasSlopesThatAreItsGradientByFzAndFzbar) {
  const DensityModel m = SymmetricArap::model(s1, s2);
  const LinearMap map = map_of(corners_of(s1, s2));
  const DensitySlopes slopes = SymmetricArap::slopes(map);
  const double scale = 1e-9 * (std::abs(m.d1) + std::abs(m.d2) + m.value);
  EXPECT_NEAR(slopes.value, m.value, scale);
  EXPECT_NEAR(slopes.by_fz * std::abs(map.fz), m.d1 + m.d2, scale);
  EXPECT_NEAR(slopes.by_fzbar * std::abs(map.fzbar), m.d1 - m.d2, scale);
}

INSTANTIATE_TEST_SUITE_P(SingularValues, ArapAt,
                         testing::Values(std::pair(3.0, 2.0), std::pair(1.2, 0.7),
                                         std::pair(1.0, 0.5), std::pair(0.1, 0.01),
                                         std::pair(50.0, 0.02)));

TEST(SymmetricArap, HasFinitePositiveModelsOfOneGradientEverywhere) {
  for (const double a : {0.01, 0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 50.0}) {
    for (const double ratio : {1.0, 1 - 1e-12, 0.999, 0.7, 0.1}) {
      const Vector6 x = corners_of(a, a * ratio);
      const FaceModel newton = model_of(x, SymmetricArap{});
      const FaceModel proxy = model_of(x, SymmetricArap::Proxy{});
      for (const FaceModel& model : {newton, proxy}) {
        ASSERT_TRUE(model.hessian.allFinite()) << a << ' ' << ratio;
        EXPECT_GE(least_eigenvalue(model.hessian), -1e-12 * model.hessian.norm());
      }
      EXPECT_EQ(newton.gradient, proxy.gradient);
    }
  }
}

TEST(SymmetricArap, IsLeastAtAnIsometry) {
  EXPECT_EQ(SymmetricArap::value(1, 1), 0);
  EXPECT_LE(model_of(corners_of(1, 1), SymmetricArap{}).gradient.norm(), 1e-14);
}

// ---- The measure ----------------------------------------------------------------------------

Distortion measure(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  return measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(1));
}

TEST(MeasureDistortion, OfTheIdentityIsLeast) {
  const DiskMesh mesh = disks::disk(meshes::grid(5, 3));
  const Distortion d = measure(mesh, disks::flat_uvs(mesh));
  EXPECT_NEAR(d.symmetric_dirichlet, 2, 1e-13);
  EXPECT_NEAR(d.symmetric_arap, 0, 1e-13);
  EXPECT_NEAR(d.max, 2, 1e-13);
  EXPECT_EQ(d.left_out, 0);
}

TEST(MeasureDistortion, OfAUniformScaleIsKnown) {
  const DiskMesh mesh = disks::disk(meshes::grid(5, 3));
  for (const double s : {0.01, 0.5, 3.0}) {
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    for (Vec2& w : uvs) w *= s;
    const Distortion d = measure(mesh, uvs);
    const double expected = s * s + 1 / (s * s);
    EXPECT_NEAR(d.symmetric_dirichlet, expected, 1e-12 * expected);
    const double arap = (s - 1) * (s - 1) + (1 / s - 1) * (1 / s - 1);
    EXPECT_NEAR(d.symmetric_arap, arap, 1e-12 * expected);
  }
}

TEST(MeasureDistortion, OfAStretchIsKnown) {
  const DiskMesh mesh = disks::disk(meshes::grid(2, 2));
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w = {3 * w.y(), -0.5 * w.x()};  // s1 = 3, s2 = 1/2
  const Distortion d = measure(mesh, uvs);
  EXPECT_NEAR(d.symmetric_dirichlet, 0.5 * (9 + 0.25 + 1 / 9.0 + 4), 1e-12);
  EXPECT_NEAR(d.symmetric_arap, 4 + 1, 1e-12);
}

TEST(MeasureDistortion, WeighsFacesByTheirAreaInSpace) {
  // Two faces side by side of areas 1/2 and 3/2, the second one twice as wide in the plane.
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {4, 0, 0}};
  const std::vector<Triangle> faces = {{0, 1, 2}, {1, 3, 2}};
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}, {7, 0}};
  std::array<double, 2> energies{};
  const Distortion d = measure_distortion(positions, faces, uvs, energies.data(), Work(1));
  EXPECT_NEAR(energies[0], 2, 1e-13);
  EXPECT_NEAR(d.symmetric_dirichlet, (0.5 * energies[0] + 1.5 * energies[1]) / 2, 1e-12);
  EXPECT_EQ(d.worst_face, 1);
  EXPECT_EQ(d.max, energies[1]);
}

TEST(MeasureDistortion, LeavesOutAndCountsFacesWithoutAnEnergy) {
  // One good face, one flipped, one collapsed in the plane, one without area in space.
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  const std::vector<Triangle> faces = {{0, 2, 1}, {0, 1, 2}, {0, 1, 3}, {1, 3, 2}};
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}};
  std::array<double, 4> energies{};
  const Distortion d = measure_distortion(positions, faces, uvs, energies.data(), Work(1));
  EXPECT_EQ(d.left_out, 3);
  EXPECT_EQ(d.worst_face, 1);
  EXPECT_NEAR(d.symmetric_dirichlet, 2, 1e-13);
  for (const int f : {0, 2, 3}) EXPECT_EQ(energies[f], std::numeric_limits<double>::infinity());
}

TEST(MeasureDistortion, OfNothingButBadFacesHasNoWorstFace) {
  const Distortion d = measure_distortion({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 2, 1}},
                                          {{0, 0}, {1, 0}, {0, 1}}, nullptr, Work(1));
  EXPECT_EQ(d.left_out, 1);
  EXPECT_EQ(d.worst_face, kNone);
  EXPECT_TRUE(std::isnan(d.symmetric_dirichlet) && std::isnan(d.symmetric_arap));
}

std::vector<Vec2> jittered(const DiskMesh& mesh, Random& random) {
  std::vector<Vec2> uvs = disks::flat_uvs(mesh);
  for (Vec2& w : uvs) w += 0.02 * random.vec2();
  return uvs;
}

TEST(MeasureDistortion, DoesNotDependOnTheFirstCornerOfAFace) {
  Random random(2);
  DiskMesh mesh = disks::disk(meshes::bumps(8, 8));
  const std::vector<Vec2> uvs = jittered(mesh, random);
  const Distortion before = measure(mesh, uvs);
  for (Triangle& t : mesh.faces) std::rotate(t.begin(), t.begin() + random.below(3), t.end());
  const Distortion after = measure(mesh, uvs);
  EXPECT_NEAR(after.symmetric_dirichlet, before.symmetric_dirichlet,
              1e-12 * before.symmetric_dirichlet);
  EXPECT_NEAR(after.symmetric_arap, before.symmetric_arap, 1e-12 * before.symmetric_arap);
  EXPECT_EQ(after.worst_face, before.worst_face);
}

TEST(MeasureDistortion, FindsTheWorstFace) {
  Random random(3);
  const DiskMesh mesh = disks::disk(meshes::bumps(8, 8));
  std::vector<double> energies(mesh.faces.size());
  const Distortion d = measure_distortion(mesh.positions, mesh.faces, jittered(mesh, random),
                                          energies.data(), Work(1));
  const auto worst = std::max_element(energies.begin(), energies.end());
  EXPECT_EQ(d.worst_face, worst - energies.begin());
  EXPECT_EQ(d.max, *worst);
}

TEST(MeasureDistortion, HasTheSameBitsOnTwoThreads) {
  Random random(4);
  const DiskMesh mesh = disks::disk(meshes::bumps(100, 100));
  const std::vector<Vec2> uvs = jittered(mesh, random);
  const Distortion one = measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(1));
  const Distortion two = measure_distortion(mesh.positions, mesh.faces, uvs, nullptr, Work(2));
  EXPECT_EQ(one.symmetric_dirichlet, two.symmetric_dirichlet);
  EXPECT_EQ(one.symmetric_arap, two.symmetric_arap);
  EXPECT_EQ(one.worst_face, two.worst_face);
}

TEST(MeasureFace, HasTheGreaterSingularValueFirstToTheLastBit) {
  Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(2.0, random.between(-3, 3)), turn = random.between(0, 7);
    std::array<Vec3, 3> p;
    std::array<Vec2, 3> w;
    for (int k = 0; k < 3; ++k) {
      p[k] = {random.unit(), random.unit(), 0};
      const double mirrored = i % 2 == 0 ? -p[k].x() : p[k].x();
      w[k] = scale * Vec2(std::cos(turn) * mirrored - std::sin(turn) * p[k].y(),
                          std::sin(turn) * mirrored + std::cos(turn) * p[k].y());
    }
    const FaceDistortion d = measure_face(p, w);
    ASSERT_GE(d.s1, std::abs(d.s2)) << i;
  }
}

TEST(MeasureFace, MeasuresTheSameAtTheEndsOfTheRangeOfNumbers) {
  const std::array<Vec3, 3> p = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.25, 0.5, 0)};
  const std::array<Vec2, 3> w = {Vec2(0, 0), Vec2(1.5, 0.25), Vec2(0.25, 0.75)};
  const FaceDistortion plain = measure_face(p, w);
  for (const int exponent : {-1060, -1000, -600, -300, 300, 600, 1000, 1022}) {
    const double unit = std::ldexp(1.0, exponent);
    const FaceDistortion d = measure_face({unit * p[0], unit * p[1], unit * p[2]},
                                          {unit * w[0], unit * w[1], unit * w[2]});
    EXPECT_EQ(d.s1, plain.s1) << exponent;
    EXPECT_EQ(d.s2, plain.s2) << exponent;
    EXPECT_EQ(d.symmetric_dirichlet, plain.symmetric_dirichlet) << exponent;
    const Distortion mean =
        measure_distortion({unit * p[0], unit * p[1], unit * p[2]}, {{0, 1, 2}},
                           {unit * w[0], unit * w[1], unit * w[2]}, nullptr, Work(1));
    EXPECT_EQ(mean.symmetric_dirichlet, plain.symmetric_dirichlet) << exponent;
    EXPECT_EQ(mean.left_out, 0) << exponent;
  }
  const FaceDistortion shrunk =
      measure_face(p, {0x1p-700 * w[0], 0x1p-700 * w[1], 0x1p-700 * w[2]});
  EXPECT_EQ(shrunk.s1, 0x1p-700 * plain.s1);
}

TEST(MeasureDistortion, StaysAccurateOnSlivers) {
  // A needle of height 1e-7, mapped by the identity.
  const Distortion d = measure_distortion({{0, 0, 0}, {1, 0, 0}, {0.3, 1e-7, 0}}, {{2, 0, 1}},
                                          {{0, 0}, {1, 0}, {0.3, 1e-7}}, nullptr, Work(1));
  EXPECT_NEAR(d.symmetric_dirichlet, 2, 1e-8);
}

}  // namespace
}  // namespace beltrami
