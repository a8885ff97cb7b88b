#include "flatten/metric.h"

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "flatten/dirichlet.h"

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
    : solver_(make_spd_solver(options)) {
  MeshMatrix laplacian(mesh.vertex_count(), mesh.faces, held, 1);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto weights = edge_weights(rest[f], metric[f]);
    for (int k = 0; k < 3; ++k) {
      const int i = next_corner(k), j = previous_corner(k);
      const double w = weights[k];
      laplacian.add(f, mesh.faces[f], i, i, [=](int, int) { return w; });
      laplacian.add(f, mesh.faces[f], j, j, [=](int, int) { return w; });
      laplacian.add(f, mesh.faces[f], i, j, [=](int, int) { return -w; });
    }
  }
  row_ = laplacian.rows();
  free_count_ = laplacian.free_count();
  if (free_count_ == 0) return;
  solver_->analyze(laplacian.matrix(), laplacian.places(mesh.positions));
  if (!solver_->factorize(laplacian.matrix())) {
    throw Error(
        BELTRAMI_E_SOLVER,
        "the Laplacian of the prolonged metric is not definite in floating point: the faces "
        "of the mesh are too degenerate; try the method cm");
  }
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
  if (free_count_ == 0) return DenseMatrix::Zero(rhs.rows(), rhs.cols());
  DenseMatrix packed(free_count_, rhs.cols());
  for (Index v = 0; v < size_of(row_); ++v) {
    if (row_[v] != kNone) packed.row(row_[v]) = rhs.row(v);
  }
  packed = (solver_.get()->*inverse)(packed);
  DenseMatrix result = DenseMatrix::Zero(rhs.rows(), rhs.cols());
  for (Index v = 0; v < size_of(row_); ++v) {
    if (row_[v] != kNone) result.row(v) = packed.row(row_[v]);
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
