#include "cut/astray.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Costs are exp(kAmplitude times the sum of three waves) times as high.
constexpr double kAmplitude = 0.25;
/// Of the waves, in roots of the area.
constexpr double kWaveLength = 1.0 / 3;
constexpr int kWays = 8;

}  // namespace

std::vector<double> costs_astray(const Surface& surface, const std::vector<double>& cost,
                                 int number, const Work& work) {
  const int way = number % kWays;
  if (way == 0) return cost;
  const double scale = 1 / (kWaveLength * std::sqrt(surface_area(surface, work)));
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.positions) box.extend(p);
  const std::array<Vec3, 3> directions = {Vec3(0.36, 0.48, 0.8), Vec3(0.8, -0.6, 0),
                                          Vec3(0.48, 0.64, -0.6)};
  std::vector<double> factor;
  for (const Vec3& p : surface.positions) {
    double waves = 0;
    for (int k = 0; k < 3; ++k) {
      const double pitch = 1 + 0.2 * (way * (k + 1) % 5);
      const double turns = scale * pitch * directions[k].dot(p - box.center());
      waves += portable::sin(2 * std::numbers::pi * turns + way * (2.1 + k));
    }
    factor.push_back(portable::exp(kAmplitude * waves));
  }
  std::vector<double> astray = cost;
  for (Index h = 0; h < size_of(astray); ++h) {
    astray[h] *= std::sqrt(factor[surface.origin(h)] * factor[surface.target(h)]);
  }
  return astray;
}

}  // namespace beltrami
