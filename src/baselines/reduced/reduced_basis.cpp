#include "baselines/reduced/reduced_basis.h"

#include <utility>

#include "linear/mesh_matrix.h"

namespace beltrami {

ReducedBasis::ReducedBasis(const DiskMesh& mesh, const std::vector<Cotangents>& cotangents,
                           MetaVertices metas, const Work& work)
    : mesh_(mesh), metas_(std::move(metas)), position_(mesh.vertex_count(), kNone) {
  for (Index i = 0; i < size_of(mesh.boundary); ++i) position_[mesh.boundary[i]] = i;
  std::vector<Eigen::Triplet<double>> pull;
  MeshMatrix laplacian =
      assemble_laplacian(work, mesh.vertex_count(), mesh.faces, cotangents, mesh.on_boundary,
                         [&](Index row, Index vertex, double weight) {
                           const Index at = position_[vertex], meta = metas_.piece[at];
                           const double share = metas_.share[at];
                           pull.emplace_back(row, meta, weight * (1 - share));
                           if (share > 0) pull.emplace_back(row, metas_.next(meta), weight * share);
                         });
  row_ = laplacian.rows();
  pull_.resize(laplacian.free_count(), metas_.count());
  pull_.setFromTriplets(pull.begin(), pull.end());
  if (laplacian.free_count() > 0)
    solver_ = factorize_laplacian(laplacian, mesh.positions, {}, work);
}

DenseMatrix ReducedBasis::rows(const std::vector<Index>& vertices) const {
  std::vector<Index> interior;
  for (const Index v : vertices) {
    if (row_[v] != kNone) interior.push_back(row_[v]);
  }
  DenseMatrix inner(0, metas_.count());
  if (!interior.empty()) inner = solver_->solve_rows(pull_, interior);
  DenseMatrix result = DenseMatrix::Zero(size_of(vertices), metas_.count());
  Index taken = 0;
  for (Index i = 0; i < size_of(vertices); ++i) {
    const Index at = position_[vertices[i]];
    if (at == kNone) {
      result.row(i) = inner.row(taken++);
      continue;
    }
    result(i, metas_.piece[at]) = 1 - metas_.share[at];
    if (metas_.share[at] > 0) result(i, metas_.next(metas_.piece[at])) = metas_.share[at];
  }
  return result;
}

std::vector<Vec2> ReducedBasis::expand(const std::vector<Vec2>& x) const {
  DenseMatrix places(metas_.count(), 2);
  for (Index m = 0; m < metas_.count(); ++m) places.row(m) = x[m].transpose();
  DenseMatrix interior(0, 2);
  if (pull_.rows() > 0) interior = solver_->solve(pull_ * places);
  std::vector<Vec2> uvs(mesh_.vertex_count());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (row_[v] != kNone) {
      uvs[v] = interior.row(row_[v]).transpose();
      continue;
    }
    const Index meta = metas_.piece[position_[v]];
    const double share = metas_.share[position_[v]];
    uvs[v] = (1 - share) * x[meta] + share * x[metas_.next(meta)];
  }
  return uvs;
}

}  // namespace beltrami
