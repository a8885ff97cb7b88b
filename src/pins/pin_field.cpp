#include "pins/pin_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
/// Cones cost their number cubed, and for each vertex their number.
constexpr std::size_t kMostCones = 400;
/// An affine map that squeezes by more than that would fold what pins only bend.
constexpr double kLeastSqueeze = 0.1;
/// The spread of points on a line across it, relative to that along it.
constexpr double kFlat = 1e-3;
/// Of the diagonal: pivots below are of points at one place but for rounding.
constexpr double kNoPivot = 1e-13;

using Matrix2 = Eigen::Matrix2d;

/// z -> slope * (z - centre) + mean.
struct Affine {
  Matrix2 slope = Matrix2::Zero();
  Vec2 centre = Vec2::Zero(), mean = Vec2::Zero();

  Vec2 at(const Vec2& place) const { return slope * (place - centre) + mean; }
};

/// Whether places that move by `slope` stay apart.
bool is_gentle(const Matrix2& slope) {
  const Matrix2 map = Matrix2::Identity() + slope;
  const double det = map(0, 0) * map(1, 1) - map(0, 1) * map(1, 0);
  // s1^2 + s2^2 and s1 s2: their quotient tells s2 / s1.
  return det > kLeastSqueeze * map.squaredNorm() / (1 + kLeastSqueeze * kLeastSqueeze);
}

/// The mean shift, and with `affinely` the least squares fit where that neither folds nor squeezes.
Affine fit(const std::vector<Vec2>& places, const std::vector<Vec2>& displacements, bool affinely) {
  Affine affine;
  const auto count = static_cast<double>(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    affine.centre += places[i] / count;
    affine.mean += displacements[i] / count;
  }
  if (!affinely) return affine;
  Matrix2 moments = Matrix2::Zero(), mixed = Matrix2::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec2 z = places[i] - affine.centre, d = displacements[i] - affine.mean;
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 2; ++c) {
        moments(r, c) += z[r] * z[c];
        mixed(r, c) += d[r] * z[c];
      }
    }
  }
  const double det = moments(0, 0) * moments(1, 1) - moments(0, 1) * moments(1, 0);
  const double trace = moments(0, 0) + moments(1, 1);
  if (!(det > kFlat * kFlat * trace * trace)) return affine;
  Matrix2 adjugate;
  adjugate << moments(1, 1), -moments(0, 1), -moments(1, 0), moments(0, 0);
  const Matrix2 slope = mixed * adjugate / det;
  if (is_gentle(slope)) affine.slope = slope;
  return affine;
}

/// Sums of -|z - z_i| that vanish at z_0, with coefficients that add up to zero: this kernel is
/// definite.
double kernel(const Vec2& a, const Vec2& b, const Vec2& origin) {
  return (a - origin).norm() + (b - origin).norm() - (a - b).norm();
}

/// The coefficients with which the kernels of places 1, 2, ... take the values there, by Cholesky's
/// factorization in place; those of places that others leave no room for are zero.
std::vector<Vec2> cone_heights(const std::vector<Vec2>& places, std::vector<Vec2> values) {
  const std::size_t n = places.size() - 1;
  std::vector<double> factor(n * n);  // rows of the lower triangle
  std::vector<bool> skipped(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    poll_interrupt();
    double* row = &factor[i * n];
    for (std::size_t j = 0; j <= i; ++j) {
      const double* other = &factor[j * n];
      double sum = kernel(places[i + 1], places[j + 1], places[0]);
      const double whole = sum;
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j < i) {
        row[j] = skipped[j] ? 0 : sum / other[j];
      } else {
        skipped[i] = !(sum > kNoPivot * whole);
        row[i] = skipped[i] ? 1 : std::sqrt(sum);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) values[i] -= factor[i * n + k] * values[k];
    values[i] = skipped[i] ? Vec2(0, 0) : Vec2(values[i] / factor[i * n + i]);
  }
  for (std::size_t i = n; i-- > 0;) {
    if (!skipped[i]) values[i] /= factor[i * n + i];
    for (std::size_t k = 0; k < i; ++k) values[k] -= factor[i * n + k] * values[i];
  }
  return values;
}

}  // namespace

PinField::PinField(const DiskMesh& mesh, const std::vector<Index>& pins, const Work& work)
    : mesh_(mesh), pins_(pins), work_(work) {}

std::vector<Vec2> PinField::by_cones(const std::vector<Vec2>& uvs, std::vector<Vec2> displacements,
                                     bool affinely) const {
  std::vector<Vec2> places;
  for (const Index v : pins_) places.push_back(uvs[v]);
  const Affine affine = fit(places, displacements, affinely);
  std::vector<Vec2> rest;
  for (std::size_t i = 0; i < places.size(); ++i) {
    displacements[i] -= affine.at(places[i]);
    if (i > 0) rest.push_back(displacements[i] - displacements[0]);
  }
  const std::vector<Vec2> heights = cone_heights(places, std::move(rest));
  std::vector<Vec2> field(uvs.size());
  parallel_for(work_, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      field[v] = affine.at(uvs[v]) + displacements[0];
      for (std::size_t i = 0; i < heights.size(); ++i) {
        field[v] += kernel(uvs[v], places[i + 1], places[0]) * heights[i];
      }
    }
  });
  return field;
}

std::vector<Vec2> PinField::harmonic(const std::vector<Vec2>& displacements) {
  std::vector<Vec2> field(mesh_.positions.size(), Vec2::Zero());
  std::vector<bool> held(field.size(), false);
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    held[pins_[i]] = true;
    field[pins_[i]] = displacements[i];
  }
  if (!laplacian_) {
    laplacian_ = std::make_unique<MeshMatrix>(mesh_.vertex_count(), mesh_.faces, held, 1, work_);
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      for (int k = 0; k < 3; ++k) {
        const Triangle& face = mesh_.faces[f];
        laplacian_->add(f, face, k, k, [](int, int) { return 1.0; });
        laplacian_->add(f, face, k, next_corner(k), [](int, int) { return -0.5; });
      }
    }
    if (laplacian_->free_count() > 0) {
      solver_ = make_spd_solver({}, work_);
      solver_->analyze(laplacian_->matrix(), laplacian_->places(mesh_.positions));
      if (!solver_->factorize(laplacian_->matrix())) {
        throw Error(Fault::kSolver, "the linear system of the pins is not definite");
      }
    }
  }
  if (laplacian_->free_count() == 0) return field;
  DenseMatrix rhs = DenseMatrix::Zero(laplacian_->free_count(), 2);
  for (const Triangle& face : mesh_.faces) {
    for (int k = 0; k < 3; ++k) {
      const Index a = face[k], b = face[next_corner(k)];
      if (!held[a] && held[b]) rhs.row(laplacian_->row(a)) += 0.5 * field[b].transpose();
      if (!held[b] && held[a]) rhs.row(laplacian_->row(b)) += 0.5 * field[a].transpose();
    }
  }
  const DenseMatrix solution = solver_->solve(rhs);
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (!held[v]) field[v] = solution.row(laplacian_->row(v)).transpose();
  }
  return field;
}

std::vector<Vec2> PinField::extend(const std::vector<Vec2>& uvs,
                                   const std::vector<Vec2>& displacements,
                                   const std::function<double(const std::vector<Vec2>&)>& energy) {
  const auto at_pins = [&](std::vector<Vec2> field) {
    for (std::size_t i = 0; i < pins_.size(); ++i) field[pins_[i]] = displacements[i];
    return field;
  };
  if (pins_.size() > kMostCones) return at_pins(harmonic(displacements));
  const auto energy_after = [&](const std::vector<Vec2>& field) {
    std::vector<Vec2> moved = uvs;
    for (std::size_t v = 0; v < uvs.size(); ++v) moved[v] += field[v];
    return energy(moved);
  };
  std::vector<Vec2> affinely = at_pins(by_cones(uvs, displacements, true));
  std::vector<Vec2> shifted = at_pins(by_cones(uvs, displacements, false));
  return energy_after(shifted) < energy_after(affinely) ? shifted : affinely;
}

}  // namespace beltrami
