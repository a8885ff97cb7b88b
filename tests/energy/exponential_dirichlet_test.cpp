// The exponential symmetric Dirichlet energy against finite differences, where it is an exponential
// and where it has gone over into a parabola.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "descend/assembly.h"
#include "descend/tutte.h"
#include "energy/density.h"
#include "energy/energy.h"
#include "energy/exponential_dirichlet.h"
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
using Density = ExponentialDirichlet;

class ExponentialAt : public testing::TestWithParam<std::pair<double, double>> {
 protected:
  const double s1 = GetParam().first, s2 = GetParam().second;
};

TEST_P(ExponentialAt, HasTheGradientOfItsValue) {
  const DensityModel m = Density::model(s1, s2);
  const double h1 = 1e-6 * s1, h2 = 1e-6 * s2;
  const double scale = std::max(std::abs(m.d1), std::abs(m.d2)) + m.value;
  EXPECT_EQ(m.value, Density::value(s1, s2));
  EXPECT_NEAR(m.d1, (Density::value(s1 + h1, s2) - Density::value(s1 - h1, s2)) / (2 * h1),
              1e-8 * scale);
  EXPECT_NEAR(m.d2, (Density::value(s1, s2 + h2) - Density::value(s1, s2 - h2)) / (2 * h2),
              1e-8 * scale);
}

TEST_P(ExponentialAt, HasTheRadialHessianOfItsValueWhichIsPositive) {
  const auto model = Density::model;
  const DensityModel m = model(s1, s2);
  const double h1 = 1e-5 * s1, h2 = 1e-5 * s2, scale = std::max(m.h11, m.h22);
  EXPECT_NEAR(m.h11, (model(s1 + h1, s2).d1 - model(s1 - h1, s2).d1) / (2 * h1), 1e-7 * scale);
  EXPECT_NEAR(m.h22, (model(s1, s2 + h2).d2 - model(s1, s2 - h2).d2) / (2 * h2), 1e-7 * scale);
  EXPECT_NEAR(m.h12, (model(s1, s2 + h2).d1 - model(s1, s2 - h2).d1) / (2 * h2), 1e-7 * scale);
  EXPECT_GT(m.h11, 0);
  EXPECT_GT(m.h22, 0);
  EXPECT_GT(m.h11 * m.h22 - m.h12 * m.h12, 0);
}

TEST_P(ExponentialAt, HasTheFaceGradientOfItsEnergy) {
  const Vector6 x = corners_of(s1, s2);
  const Vector6 gradient = model_of(x, Density{}).gradient;
  const double h = 1e-5 * s2;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = h * Vector6::Unit(i);
    EXPECT_NEAR(gradient[i],
                (energy_of<Density>(x + step) - energy_of<Density>(x - step)) / (2 * h),
                1e-7 * (gradient.norm() + energy_of<Density>(x)))
        << i;
  }
}

TEST_P(ExponentialAt, HasTheFaceHessianOfItsEnergyButForTheClampedTwist) {
  const Vector6 x = corners_of(s1, s2);
  const Matrix6 modelled = model_of(x, Density{}).hessian;
  const Matrix6 true_hessian = hessian_by_differences<Density>(x, 1e-5 * s2);
  const double tolerance = 1e-6 * modelled.norm();
  EXPECT_GE(least_eigenvalue(modelled), -1e-12 * modelled.norm());
  EXPECT_GE(least_eigenvalue(modelled - true_hessian), -tolerance);
  const DensityModel m = Density::model(s1, s2);
  EXPECT_NEAR(m.twist, std::max(0.0, 2 * (m.d1 + m.d2) / (s1 + s2)), 1e-12 * (1 + m.twist));
  if (m.d1 + m.d2 >= 0) {
    EXPECT_LE((modelled - true_hessian).norm(), tolerance);
  }
}

TEST_P(ExponentialAt, HasAProxyOfTheSameValueAndGradientWithAPositiveHessian) {
  const DensityModel exact = Density::model(s1, s2), proxy = Density::Proxy::model(s1, s2);
  EXPECT_EQ(proxy.value, exact.value);
  EXPECT_LE(std::abs(proxy.coupling), std::sqrt(proxy.twist * proxy.flip));
  const Vector6 x = corners_of(s1, s2);
  const FaceModel model = model_of(x, Density::Proxy{});
  EXPECT_EQ(model.gradient, model_of(x, Density{}).gradient);
  EXPECT_GE(least_eigenvalue(model.hessian), -1e-12 * model.hessian.norm());
}

// H (x - rotation) = gradient: the model's minimum is the closest rotation of the rest triangle.
TEST_P(ExponentialAt, HasAProxyWhoseMinimumIsTheClosestRotation) {
  const Vector6 x = corners_of(s1, s2);
  const Complex fz = map_of(x).fz;
  Vector6 rotated;
  for (int k = 0; k < 3; ++k) {
    const Complex w = fz / std::abs(fz) * faces::kRest.corner(k);
    rotated.segment<2>(2 * k) << w.real(), w.imag();
  }
  const FaceModel model = model_of(x, Density::Proxy{});
  const Vector6 product = model.hessian * (x - rotated);
  EXPECT_LE((product - model.gradient).norm(), 1e-9 * (1 + model.hessian.norm()));
}

TEST_P(ExponentialAt, HasSlopesThatAreItsGradientByFzAndFzbar) {
  const DensityModel m = Density::model(s1, s2);
  const LinearMap map = map_of(corners_of(s1, s2));
  const DensitySlopes slopes = Density::slopes(map);
  const double scale = 1e-9 * (std::abs(m.d1) + std::abs(m.d2) + m.value);
  EXPECT_NEAR(slopes.value, m.value, scale);
  EXPECT_NEAR(slopes.by_fz * std::abs(map.fz), m.d1 + m.d2, scale);
  EXPECT_NEAR(slopes.by_fzbar * std::abs(map.fzbar), m.d1 - m.d2, scale);
}

// (2.5, 0.21) is just below the end of the exponential, (2.5, 0.2) beyond.
INSTANTIATE_TEST_SUITE_P(SingularValues, ExponentialAt,
                         testing::Values(std::pair(3.0, 2.0), std::pair(2.0, 2.0),
                                         std::pair(1.0, 1.0), std::pair(1.0, 0.5),
                                         std::pair(2.5, 0.22), std::pair(2.5, 0.2),
                                         std::pair(0.1, 0.05), std::pair(50.0, 0.02)));

TEST(ExponentialDirichlet, IsLeastAtAnIsometryWithTheCurvatureOfSymmetricDirichlet) {
  EXPECT_EQ(Density::value(1, 1), 2);
  const DensityModel m = Density::model(1, 1), d = SymmetricDirichlet::model(1, 1);
  EXPECT_EQ(m.d1, 0);
  EXPECT_EQ(m.d2, 0);
  for (const auto part : {&DensityModel::h11, &DensityModel::h12, &DensityModel::h22,
                          &DensityModel::twist, &DensityModel::flip}) {
    EXPECT_EQ(m.*part, d.*part);
  }
  EXPECT_EQ(m.h11, Density::kCurvature);
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const double a = random.between(0.1, 5), b = random.between(0.1, 5);
    EXPECT_GE(Density::value(a, b), SymmetricDirichlet::value(a, b) - 1e-15);
  }
}

TEST(ExponentialDirichlet, IsTheExponentialUpToItsEndAndNoHigherBeyond) {
  for (double s2 = 1; s2 > 0.01; s2 *= 0.9) {
    const double dirichlet = SymmetricDirichlet::value(1, s2), value = Density::value(1, s2);
    const double exponential = 1 + portable::exp(dirichlet - 2);
    if (dirichlet <= 14) {
      EXPECT_EQ(value, exponential);
    } else {
      EXPECT_LT(value, exponential);
    }
  }
}

TEST(ExponentialDirichlet, IsTwiceDifferentiableAtTheEndOfTheExponential) {
  // 1/2 (4 + 1/4 + s^2 + s^-2) = 14 at this s.
  const double s = std::sqrt(0.5 * (23.75 - std::sqrt(23.75 * 23.75 - 4))), h = 1e-9;
  const double larger = s * (1 + h), smaller = s * (1 - h);
  EXPECT_LT(SymmetricDirichlet::value(2, larger), 14);
  EXPECT_GT(SymmetricDirichlet::value(2, smaller), 14);
  const DensityModel before = Density::model(2, larger), after = Density::model(2, smaller);
  for (const auto part :
       {&DensityModel::value, &DensityModel::d1, &DensityModel::d2, &DensityModel::h11,
        &DensityModel::h12, &DensityModel::h22, &DensityModel::flip}) {
    EXPECT_NEAR(after.*part / before.*part, 1, 1e-6);
  }
}

TEST(ExponentialDirichlet, HasFinitePositiveModelsAtHugeDistortions) {
  for (const double a : {1e-20, 1e-6, 0.01, 1.0, 50.0, 1e6, 1e20}) {
    for (const double ratio : {1.0, 1 - 1e-12, 0.7, 1e-3, 1e-9}) {
      for (const DensityModel& m :
           {Density::model(a, a * ratio), Density::Proxy::model(a, a * ratio)}) {
        for (const auto part :
             {&DensityModel::value, &DensityModel::d1, &DensityModel::d2, &DensityModel::h11,
              &DensityModel::h12, &DensityModel::h22, &DensityModel::twist, &DensityModel::flip}) {
          ASSERT_TRUE(std::isfinite(m.*part)) << a << ' ' << ratio;
        }
        EXPECT_GE(std::min({m.h11, m.h22, m.twist, m.flip}), 0) << a << ' ' << ratio;
        EXPECT_LE(std::abs(m.h12), (1 + 1e-12) * std::sqrt(m.h11) * std::sqrt(m.h22));
      }
    }
  }
  EXPECT_EQ(Density::value(1, 1e-200), std::numeric_limits<double>::infinity());
}

TEST(ExponentialDirichlet, KnowsWhatItIsAsSymmetricDirichlet) {
  EXPECT_EQ(Density::to_dirichlet(2), 2);
  EXPECT_NEAR(Density::from_dirichlet(3), 1 + std::exp(1.0), 1e-14);
  for (const double dirichlet : {2.0, 2.001, 2.5, 5.0, 13.999, 14.0, 14.001, 20.0, 1e3, 1e9}) {
    EXPECT_NEAR(Density::to_dirichlet(Density::from_dirichlet(dirichlet)) / dirichlet, 1, 1e-12);
  }
}

// ---- The best scale ---------------------------------------------------------------------------

TEST(ExponentialDirichlet, IsLeastAtItsBestScaleWhateverTheScaleBefore) {
  constexpr Energy kEnergy = Energy::kExponentialDirichlet;
  Random random(5);
  const DiskMesh mesh = disks::disk(meshes::grid(8, 8));
  const auto rest = disks::rest_of(mesh);
  for (const double bend : {0.01, 0.5, 5.0}) {
    std::vector<Vec2> uvs = disks::flat_uvs(mesh);
    for (Vec2& w : uvs) {
      const Vec2 p = w;
      w = {p.x() * (1 + bend * p.x() * p.x()), p.y() * (1 + bend * p.x())};
    }
    const double best = best_scale(kEnergy, mesh.faces, rest, uvs, Work(1));
    const auto energy_at = [&](double scale) {
      std::vector<Vec2> scaled = uvs;
      for (Vec2& w : scaled) w *= scale;
      return mean_energy(kEnergy, mesh.faces, rest, scaled, Work(1));
    };
    for (const double off : {0.9, 0.999, 1.001, 1.1}) {
      EXPECT_LT(energy_at(best), energy_at(off * best)) << bend << ' ' << off;
    }
    for (const double before : {1e-8, 0.1, 3.0, 1e12}) {
      std::vector<Vec2> scaled = uvs;
      for (Vec2& w : scaled) w *= before;
      EXPECT_NEAR(before * best_scale(kEnergy, mesh.faces, rest, scaled, Work(1)) / best, 1, 1e-8);
    }
  }
}

}  // namespace
}  // namespace beltrami
