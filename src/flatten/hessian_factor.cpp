#include "flatten/hessian_factor.h"

#include <cstdint>

#include "base/parallel.h"
#include "descend/assembly.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "mesh/boundary.h"

namespace beltrami {
namespace {

/// Of the diagonal, added to it: enough for a factor in single precision, and little beside what
/// the flattest motions of hard models have (1e-3 of it costs .1% of their energy).
constexpr double kShift = 1e-6;
constexpr std::int64_t kGrain = 2048;  // vertices

}  // namespace

HessianFactor::HessianFactor(const DiskMesh& mesh, const Work& work)
    : mesh_(mesh), work_(work), solver_(make_spd_solver({.precision = Precision::kSingle}, work)) {}

bool HessianFactor::fit(Energy energy, const std::vector<RestTriangle>& rest,
                        const std::vector<Vec2>& uvs) {
  // Not kept: beside the factor it serves nothing.
  MeshMatrix matrix(mesh_.vertex_count(), mesh_.faces, only_first_of_boundary(mesh_), 2, work_);
  Eigen::VectorXd gradient;
  with_density(energy, [&]<class Density>(Density) {
    const auto area = [&](std::int64_t f) { return rest[f].area(); };
    const auto give = [&](std::int64_t first, std::int64_t end, FaceModels& models) {
      give_face_models(mesh_.faces, rest, uvs, first, end, Density{}, area, models);
    };
    assemble(mesh_.faces, give, matrix, gradient, work_);
  });
  SparseMatrix& lower = matrix.matrix();
  for (Eigen::Index c = 0; c < lower.cols(); ++c) {
    lower.valuePtr()[lower.outerIndexPtr()[c]] *= 1 + kShift;
  }
  if (!analyzed_) {
    row_ = matrix.rows();
    rows_ = matrix.free_count();
    solver_->analyze(lower, matrix.places(uvs));
    analyzed_ = true;
  }
  return factorize_shifted(*solver_, lower) >= 0;
}

void HessianFactor::settle() {
  solver_->keep_preconditioner();
  analyzed_ = false;
}

void HessianFactor::precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) const {
  DenseMatrix packed(2 * rows_, 1);
  parallel_for(work_, size_of(rhs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Index row = row_[v];
      if (row != kNone) packed.block<2, 1>(2 * row, 0) = rhs[v];
    }
  });
  const DenseMatrix solution = solver_->precondition(packed);
  x.resize(rhs.size());
  parallel_for(work_, size_of(rhs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Index row = row_[v];
      x[v] = row != kNone ? Vec2(solution.block<2, 1>(2 * row, 0)) : Vec2(0, 0);
    }
  });
}

}  // namespace beltrami
