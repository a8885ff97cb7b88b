#include "flatten/dirichlet.h"

#include <algorithm>

#include "base/error.h"
#include "sparse/mesh_matrix.h"
#include "sparse/spd_solver.h"

namespace beltrami {

std::vector<Vec2> carry_boundary(const DiskMesh& fine, const CoarseDisk& coarse,
                                 const std::vector<Vec2>& coarse_uvs) {
  std::vector<Vec2> uvs(fine.vertex_count(), Vec2::Zero());
  std::vector<Index> coarse_vertex(fine.vertex_count(), kNone);
  for (Index v = 0; v < size_of(coarse.fine_vertex); ++v) {
    coarse_vertex[coarse.fine_vertex[v]] = v;
  }
  const Index count = size_of(fine.boundary);
  const auto at = [&](Index i) { return fine.boundary[i % count]; };
  Index first = 0;
  while (coarse_vertex[at(first)] == kNone) ++first;
  for (Index begin = first; begin < first + count;) {
    Index end = begin + 1;
    double length = (fine.positions[at(end)] - fine.positions[at(begin)]).norm();
    while (coarse_vertex[at(end)] == kNone) {
      length += (fine.positions[at(end + 1)] - fine.positions[at(end)]).norm();
      ++end;
    }
    const Vec2& from = coarse_uvs[coarse_vertex[at(begin)]];
    const Vec2& to = coarse_uvs[coarse_vertex[at(end)]];
    uvs[at(begin)] = from;
    double along = 0;
    for (Index i = begin + 1; i < end; ++i) {
      along += (fine.positions[at(i)] - fine.positions[at(i - 1)]).norm();
      const double t = length > 0 ? along / length : static_cast<double>(i - begin) / (end - begin);
      uvs[at(i)] = (1 - t) * from + t * to;
    }
    begin = end;
  }
  return uvs;
}

std::array<double, 3> modified_cotangents(const RestTriangle& rest, Complex mu) {
  std::array<double, 3> cotangents;
  for (int k = 0; k < 3; ++k) {
    const Complex v1 = rest.corner(next_corner(k)) - rest.corner(k);
    const Complex v2 = rest.corner(previous_corner(k)) - rest.corner(k);
    const Complex q = (v1 + mu * std::conj(v1)) * std::conj(v2 + mu * std::conj(v2));
    cotangents[k] = -q.real() / q.imag();
  }
  return cotangents;
}

void solve_harmonic(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const std::vector<FaceMetric>& metric, std::vector<Vec2>& uvs, int threads) {
  MeshMatrix laplacian(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1);
  if (laplacian.free_count() == 0) return;
  DenseMatrix rhs = DenseMatrix::Zero(laplacian.free_count(), 2);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& face = mesh.faces[f];
    const auto cotangents = modified_cotangents(rest[f], metric[f].mu);
    for (int k = 0; k < 3; ++k) {
      const int i = next_corner(k), j = previous_corner(k);
      const double weight = 0.5 * cotangents[k];
      laplacian.add(f, face, i, i, [=](int, int) { return weight; });
      laplacian.add(f, face, j, j, [=](int, int) { return weight; });
      laplacian.add(f, face, i, j, [=](int, int) { return -weight; });
      const Index ri = laplacian.row(face[i]), rj = laplacian.row(face[j]);
      if (ri != kNone && rj == kNone) rhs.row(ri) += weight * uvs[face[j]].transpose();
      if (rj != kNone && ri == kNone) rhs.row(rj) += weight * uvs[face[i]].transpose();
    }
  }
  const auto solver = make_spd_solver({Precision::kSingle, threads});
  solver->analyze(laplacian.matrix(), laplacian.places(mesh.positions));
  if (!solver->factorize(laplacian.matrix())) {
    throw Error(BELTRAMI_E_SOLVER,
                "the Laplacian of the fine mesh is not definite in floating point: its faces are "
                "too degenerate; try the method cm");
  }
  const DenseMatrix solution = solver->solve(rhs);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (laplacian.row(v) != kNone) uvs[v] = solution.row(laplacian.row(v)).transpose();
  }
}

}  // namespace beltrami
