#include "repair/global_fix.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/interrupt.h"
#include "base/types.h"
#include "exact/crossings.h"
#include "linear/evaluated.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"
#include "ring/ring_faces.h"
#include "ring/triangulate_ring.h"

namespace beltrami {
namespace {

/// Bounds of the tangent of half an angle, and of a length in bounding boxes: what is folded to
/// nothing still gets a positive weight that the solve can digest.
constexpr double kLeastTangent = 1e-6, kGreatestTangent = 1e6;
constexpr double kLeastLength = 1e-9;
/// Of a residual, what a round of the iteration leaves.
constexpr double kShareLeft = 1e-6;
constexpr int kMostIterations = 100;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Tangent of half the unsigned angle between two vectors.
double half_angle_tangent(const Vec2& a, const Vec2& b) {
  const double adjacent = a.norm() * b.norm() + a.dot(b);
  const double tangent = adjacent > 0 ? std::abs(cross(a, b)) / adjacent : kGreatestTangent;
  return std::isfinite(tangent) ? std::clamp(tangent, kLeastTangent, kGreatestTangent)
                                : kLeastTangent;
}

bool is_counter_clockwise(const std::vector<Vec2>& polygon) {
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    area += cross(polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
  }
  return area > 0;
}

/// Whether places are apart by more than the roundoff where they are.
bool has_extent(const std::vector<Vec2>& places) {
  Eigen::AlignedBox2d box;
  for (const Vec2& place : places) box.extend(place);
  return box.diagonal().norm() > kLeastLength * box.center().norm();
}

/// The mesh and the ring as one triangulation of the outer circle, whose points come last.
struct Glued {
  std::vector<Triangle> faces;
  std::vector<Vec2> places;
  double extent = 0;
};

Glued glue(const DiskMesh& mesh, const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Vec2> polygon = boundary_polygon(mesh, uvs);
  const bool simple = is_simple(mesh.boundary, uvs) && is_counter_clockwise(polygon);
  const std::vector<Vec2> inner = simple ? polygon : boundary_on_circle(mesh, work);

  Glued glued{mesh.faces, uvs, 0};
  const auto circle = scaffold_circle(has_extent(uvs) ? uvs : inner);
  glued.places.insert(glued.places.end(), circle.begin(), circle.end());
  glued.extent = (circle.front() - circle[circle.size() / 2]).norm();
  glue_ring(triangulate_ring(inner, scaffold_circle(inner)).faces, mesh.boundary, size_of(uvs),
            glued.faces);
  return glued;
}

/// A matrix of the same kind with symmetric weights, as its lower triangle: each weight the
/// geometric mean of both. `matrix`: a diagonal of 1, less the weights of neighbours in each row.
SparseMatrix symmetrised(const SparseMatrix& matrix) {
  const SparseMatrix transposed = evaluated(matrix.transpose());  // of the same pattern
  std::vector<double> diagonal(matrix.cols(), 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(matrix.nonZeros() / 2 + matrix.cols());
  for (int column = 0; column < matrix.cols(); ++column) {
    SparseMatrix::InnerIterator other(transposed, column);
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry, ++other) {
      if (entry.row() == column) continue;
      const double mean = std::sqrt(entry.value() * other.value());
      // What the row has lost or won against its diagonal.
      diagonal[column] += other.value() + mean;
      if (entry.row() > column) entries.emplace_back(entry.row(), column, -mean);
    }
  }
  for (int k = 0; k < matrix.cols(); ++k) entries.emplace_back(k, k, diagonal[k]);
  SparseMatrix lower(matrix.rows(), matrix.cols());
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

std::vector<Place> places_of(const DiskMesh& mesh) {
  std::vector<Place> places;
  places.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) places.push_back(place_of(p));
  return places;
}

/// The factor of a symmetric matrix, as what an iteration by Eigen is preconditioned with.
class Preconditioner {
 public:
  Preconditioner() = default;
  void set(const SpdSolver& solver) { solver_ = &solver; }
  template <class Matrix>
  Preconditioner& analyzePattern(const Matrix&) {
    return *this;
  }
  template <class Matrix>
  Preconditioner& factorize(const Matrix&) {
    return *this;
  }
  template <class Matrix>
  Preconditioner& compute(const Matrix&) {
    return *this;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const {
    poll_interrupt();
    return solver_->solve(rhs);
  }
  Eigen::ComputationInfo info() const { return Eigen::Success; }

 private:
  const SpdSolver* solver_ = nullptr;
};

/// Improves `solution` in two rounds: the second takes what the first leaves, rounding included, as
/// a right-hand side of its own. False where the iteration does not converge. What is there when
/// the time is up will do.
bool iterate(const SparseMatrix& matrix, const SpdSolver& symmetric, const DenseMatrix& rhs,
             DenseMatrix& solution, const Work& work) {
  Eigen::BiCGSTAB<SparseMatrix, Preconditioner> solver;
  solver.preconditioner().set(symmetric);
  solver.compute(matrix);
  solver.setTolerance(kShareLeft);
  solver.setMaxIterations(kMostIterations);
  for (int round = 0; round < 2 && !work.out_of_time(); ++round) {
    const DenseMatrix residual = rhs - matrix * solution;
    if (!residual.allFinite()) return false;
    for (int k = 0; k < 2; ++k) {
      solution.col(k) += solver.solve(residual.col(k));
      if (solver.info() != Eigen::Success) return false;
    }
  }
  return solution.allFinite();
}

}  // namespace

bool embed_with_scaffold(const DiskMesh& mesh, std::vector<Vec2>& uvs, const Work& work) {
  const Glued glued = glue(mesh, uvs, work);
  const Index free = mesh.vertex_count();
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> total(free, 0.0);
  DenseMatrix rhs = DenseMatrix::Zero(free, 2);
  const auto pull = [&](Index row, Index column, double weight) {
    total[row] += weight;
    if (column < free) {
      entries.emplace_back(row, column, -weight);
    } else {
      rhs.row(row) += weight * glued.places[column].transpose();
    }
  };
  for (const Triangle& face : glued.faces) {
    for (int k = 0; k < 3; ++k) {
      const Index v = face[k], next = face[next_corner(k)], previous = face[previous_corner(k)];
      if (v >= free) continue;
      const Vec2 a = glued.places[next] - glued.places[v];
      const Vec2 b = glued.places[previous] - glued.places[v];
      const double tangent = half_angle_tangent(a, b), least = kLeastLength * glued.extent;
      pull(v, next, tangent / std::max(a.norm(), least));
      pull(v, previous, tangent / std::max(b.norm(), least));
    }
  }
  // Each row scaled to a diagonal of 1.
  std::vector<Eigen::Triplet<double>> scaled;
  scaled.reserve(entries.size() + free);
  for (const auto& e : entries) {
    scaled.emplace_back(e.row(), e.col(), e.value() / total[e.row()]);
  }
  for (Index v = 0; v < free; ++v) {
    scaled.emplace_back(v, v, 1.0);
    rhs.row(v) /= total[v];
  }
  SparseMatrix matrix(free, free);
  matrix.setFromTriplets(scaled.begin(), scaled.end());

  SparseMatrix symmetric = symmetrised(matrix);
  const std::unique_ptr<SpdSolver> solver = make_spd_solver({}, work);
  solver->analyze(symmetric, places_of(mesh));
  if (factorize_shifted(*solver, symmetric) < 0) return false;
  const DenseMatrix start = solver->solve(rhs);
  DenseMatrix solution = start;
  // Any positive weights give an embedding: where the iteration fails, those of the start do.
  if (!iterate(matrix, *solver, rhs, solution, work)) solution = start;
  if (!solution.allFinite()) return false;
  for (Index v = 0; v < free; ++v) uvs[v] = solution.row(v).transpose();
  return true;
}

}  // namespace beltrami
