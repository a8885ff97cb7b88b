#include "flatten/reduced_basis.h"

#include <utility>

#include "base/error.h"
#include "flatten/dirichlet.h"
#include "sparse/mesh_matrix.h"

namespace beltrami {

ReducedBasis::ReducedBasis(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                           const std::vector<FaceMetric>& metric, MetaVertices metas)
    : mesh_(mesh),
      metas_(std::move(metas)),
      position_(mesh.vertex_count(), kNone),
      solver_(make_spd_solver()) {
  for (Index i = 0; i < size_of(mesh.boundary); ++i) position_[mesh.boundary[i]] = i;
  MeshMatrix laplacian(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1);
  row_ = laplacian.rows();
  std::vector<Eigen::Triplet<double>> pull;
  const auto pull_towards = [&](Index row, Index boundary_vertex, double weight) {
    const Index at = position_[boundary_vertex], meta = metas_.piece[at];
    const double share = metas_.share[at];
    pull.emplace_back(row, meta, weight * (1 - share));
    if (share > 0) pull.emplace_back(row, metas_.next(meta), weight * share);
  };
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& face = mesh.faces[f];
    const auto cotangents = modified_cotangents(rest[f], metric[f].mu);
    for (int k = 0; k < 3; ++k) {
      const int i = next_corner(k), j = previous_corner(k);
      const double weight = 0.5 * cotangents[k];
      laplacian.add(f, face, i, i, [=](int, int) { return weight; });
      laplacian.add(f, face, j, j, [=](int, int) { return weight; });
      laplacian.add(f, face, i, j, [=](int, int) { return -weight; });
      const Index ri = row_[face[i]], rj = row_[face[j]];
      if (ri != kNone && rj == kNone) pull_towards(ri, face[j], weight);
      if (rj != kNone && ri == kNone) pull_towards(rj, face[i], weight);
    }
  }
  pull_.resize(laplacian.free_count(), metas_.count());
  pull_.setFromTriplets(pull.begin(), pull.end());
  if (laplacian.free_count() == 0) return;
  solver_->analyze(laplacian.matrix(), laplacian.places(mesh.positions));
  if (!solver_->factorize(laplacian.matrix())) {
    throw Error(BELTRAMI_E_SOLVER,
                "the Laplacian of the fine mesh is not definite in floating point: its faces are "
                "too degenerate; try the method cm");
  }
}

DenseMatrix ReducedBasis::rows(const std::vector<Index>& vertices, int threads) const {
  std::vector<Index> interior;
  for (const Index v : vertices) {
    if (row_[v] != kNone) interior.push_back(row_[v]);
  }
  DenseMatrix inner(0, metas_.count());
  if (!interior.empty()) inner = solver_->solve_rows(pull_, interior, threads);
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
