#include "flatten/hessian_factor.h"

#include "descend/assembly.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "mesh/boundary.h"

namespace beltrami {
namespace {

/// Of the diagonal, added to it: enough for a factor in single precision, and little beside what
/// the flattest motions of hard models have (1e-3 of it costs .1% of their energy).
constexpr double kShift = 1e-6;

}  // namespace

HessianFactor::HessianFactor(Energy energy, const DiskMesh& mesh,
                             const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                             const Work& work)
    : solver_(make_spd_solver({.precision = Precision::kSingle}, work)) {
  // Not kept: beside the factor it serves nothing.
  MeshMatrix matrix(mesh.vertex_count(), mesh.faces, only_first_of_boundary(mesh), 2, work);
  row_ = matrix.rows();
  rows_ = matrix.free_count();
  Eigen::VectorXd gradient;
  with_density(energy, [&]<class Density>(Density) {
    const auto model_of = [&](Index f) {
      const Triangle& t = mesh.faces[f];
      const LinearMap map = linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]);
      FaceModel face = face_model(rest[f], map, Density{});
      face.hessian *= rest[f].area();
      return face;
    };
    assemble(mesh.faces, model_of, matrix, gradient, work);
  });
  SparseMatrix& lower = matrix.matrix();
  for (Eigen::Index c = 0; c < lower.cols(); ++c) {
    lower.valuePtr()[lower.outerIndexPtr()[c]] *= 1 + kShift;
  }
  solver_->analyze(lower, matrix.places(uvs));
  if (factorize_shifted(*solver_, lower) < 0) solver_.reset();
}

void HessianFactor::precondition(const std::vector<Vec2>& rhs, std::vector<Vec2>& x) const {
  DenseMatrix packed(2 * rows_, 1);
  for (Index v = 0; v < size_of(rhs); ++v) {
    const Index row = row_[v];
    if (row != kNone) packed.block<2, 1>(2 * row, 0) = rhs[v];
  }
  const DenseMatrix solution = solver_->precondition(packed);
  x.resize(rhs.size());
  for (Index v = 0; v < size_of(rhs); ++v) {
    const Index row = row_[v];
    x[v] = row != kNone ? Vec2(solution.block<2, 1>(2 * row, 0)) : Vec2(0, 0);
  }
}

}  // namespace beltrami
