#include "flatten/metric.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "flatten/laplacian.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

/// Weights of the three edges of a face, each opposite to the corner of its index.
std::array<double, 3> edge_weights(const RestTriangle& rest, const FaceMetric& metric) {
  auto weights = modified_cotangents(rest, metric.mu);
  for (double& w : weights) w *= 0.5 * std::exp(-metric.log_area);
  return weights;
}

/// The corners of a face laid out in its target metric.
std::array<Complex, 3> target_corners(const RestTriangle& rest, const FaceMetric& metric) {
  const Complex fz = metric.fz(), fzbar = metric.mu * fz;
  std::array<Complex, 3> corners;
  for (int k = 0; k < 3; ++k) {
    const Complex z = rest.corner(k);
    corners[k] = fz * z + fzbar * std::conj(z);
  }
  return corners;
}

/// Weights of the edges of a face whose stiffness along each singular direction is the mean of the
/// density's radial curvature there and of its angular ones.
template <class Density>
std::array<double, 3> stiffness_weights(const RestTriangle& rest, const LinearMap& map) {
  const double a = std::abs(map.fz), b = std::abs(map.fzbar);
  if (!(a > b)) return modified_cotangents(rest, 0);
  const DensityModel model = Density::model(a + b, a - b);
  // Beside a ridge of the density the angular curvature is without bounds.
  const double angular = std::min(0.5 * (model.twist + model.flip), model.h11 + model.h22);
  const double along = 0.5 * (model.h11 + angular), across = 0.5 * (model.h22 + angular);
  // The metric whose Laplacian has this stiffness: lengths go with the inverse roots.
  const double ratio = std::sqrt(across / along), modulus = (ratio - 1) / (ratio + 1);
  const Complex direction = b > 0 ? map.fzbar / map.fz * (a / b) : Complex(1);
  auto weights = modified_cotangents(rest, modulus * direction);
  for (double& w : weights) w *= 0.5 * std::sqrt(along * across);
  return weights;
}

/// The unit complex per face that turns its target closest to the present map.
void fit_rotations(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                   const std::vector<FaceMetric>& metric, const std::vector<Vec2>& uvs, int threads,
                   std::vector<Complex>& rotation) {
  parallel_for(threads, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      const Triangle& t = mesh.faces[f];
      const auto weights = edge_weights(rest[f], metric[f]);
      const auto corners = target_corners(rest[f], metric[f]);
      Complex fit = 0;
      for (int k = 0; k < 3; ++k) {
        const int i = next_corner(k), j = previous_corner(k);
        const Vec2 edge = uvs[t[i]] - uvs[t[j]];
        fit += weights[k] * Complex(edge.x(), edge.y()) * std::conj(corners[i] - corners[j]);
      }
      if (std::abs(fit) > 0) rotation[f] = fit / std::abs(fit);
    }
  });
}

}  // namespace

MetricLaplacian::MetricLaplacian(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                 const std::vector<FaceMetric>& metric,
                                 const std::vector<bool>& held, const SolverOptions& options)
    : matrix_(mesh.vertex_count(), mesh.faces, held, 1) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    add_stiffness(matrix_, f, mesh.faces[f], edge_weights(rest[f], metric[f]));
  }
  if (matrix_.free_count() > 0) solver_ = factorize_laplacian(matrix_, mesh.positions, options);
}

void MetricLaplacian::refit(Energy energy, const DiskMesh& mesh,
                            const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                            int threads) {
  if (matrix_.free_count() == 0) return;
  std::vector<std::array<double, 3>> weights(mesh.faces.size());
  with_density(energy, [&]<class Density>(Density) {
    parallel_for(threads, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f) {
        const Triangle& t = mesh.faces[f];
        weights[f] = stiffness_weights<Density>(
            rest[f], linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
      }
    });
  });
  matrix_.set_zero();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    add_stiffness(matrix_, f, mesh.faces[f], weights[f]);
  }
  refactorize_laplacian(*solver_, matrix_);
}

DenseMatrix MetricLaplacian::solve(const DenseMatrix& rhs) const {
  return apply(rhs, &SpdSolver::solve);
}

DenseMatrix MetricLaplacian::precondition(const DenseMatrix& rhs) const {
  return apply(rhs, &SpdSolver::precondition);
}

DenseMatrix MetricLaplacian::apply(const DenseMatrix& rhs,
                                   DenseMatrix (SpdSolver::*inverse)(const DenseMatrix&)
                                       const) const {
  DenseMatrix result = DenseMatrix::Zero(rhs.rows(), rhs.cols());
  if (matrix_.free_count() == 0) return result;
  const std::vector<Index>& row = matrix_.rows();
  DenseMatrix packed(matrix_.free_count(), rhs.cols());
  for (Index v = 0; v < size_of(row); ++v) {
    if (row[v] != kNone) packed.row(row[v]) = rhs.row(v);
  }
  packed = (solver_.get()->*inverse)(packed);
  for (Index v = 0; v < size_of(row); ++v) {
    if (row[v] != kNone) result.row(v) = packed.row(row[v]);
  }
  return result;
}

void solve_metric(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  const std::vector<FaceMetric>& metric, const MetricLaplacian& laplacian,
                  int rotations, int threads, std::vector<Vec2>& uvs,
                  const Checkpoint& checkpoint) {
  std::vector<Complex> rotation(mesh.face_count(), Complex(1));
  for (int round = 0; round <= rotations; ++round) {
    checkpoint(static_cast<double>(round) / (rotations + 1));
    if (round > 0) fit_rotations(mesh, rest, metric, uvs, threads, rotation);
    // The residual of the present map, so that held vertices need no treatment of their own.
    DenseMatrix residual = DenseMatrix::Zero(mesh.vertex_count(), 2);
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Triangle& t = mesh.faces[f];
      const auto weights = edge_weights(rest[f], metric[f]);
      const auto corners = target_corners(rest[f], metric[f]);
      for (int k = 0; k < 3; ++k) {
        const int i = next_corner(k), j = previous_corner(k);
        const Complex edge = rotation[f] * (corners[i] - corners[j]);
        const Vec2 term = weights[k] * (Vec2(edge.real(), edge.imag()) - (uvs[t[i]] - uvs[t[j]]));
        residual.row(t[i]) += term.transpose();
        residual.row(t[j]) -= term.transpose();
      }
    }
    const DenseMatrix change = laplacian.solve(residual);
    for (Index v = 0; v < mesh.vertex_count(); ++v) uvs[v] += change.row(v).transpose();
  }
}

}  // namespace beltrami
