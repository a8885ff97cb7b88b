#include "flatten/dirichlet.h"

#include <algorithm>

#include "base/types.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/boundary.h"

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

std::vector<double> coarse_boundary_lengths(const DiskMesh& fine, const CoarseDisk& coarse) {
  std::vector<bool> kept(fine.vertex_count(), false);
  for (const Index v : coarse.fine_vertex) kept[v] = true;
  const std::vector<double> lengths = boundary_lengths(fine);
  const Index count = size_of(fine.boundary);
  std::vector<double> result(lengths.size());
  Index first = 0;
  while (!kept[fine.boundary[first]]) ++first;
  for (Index begin = first; begin < first + count;) {
    Index end = begin;
    double length = 0;
    do {
      length += lengths[end++ % count];
    } while (!kept[fine.boundary[end % count]]);
    for (Index i = begin; i < end; ++i) result[i % count] = length;
    begin = end;
  }
  return result;
}

void solve_harmonic(const DiskMesh& mesh, const std::vector<Cotangents>& cotangents,
                    std::vector<Vec2>& uvs, const Work& work) {
  DenseMatrix rhs = DenseMatrix::Zero(mesh.vertex_count(), 2);
  MeshMatrix laplacian =
      assemble_laplacian(work, mesh.vertex_count(), mesh.faces, cotangents, mesh.on_boundary,
                         [&](Index row, Index vertex, double weight) {
                           rhs.row(row) += weight * uvs[vertex].transpose();
                         });
  if (laplacian.free_count() == 0) return;
  const auto solver = factorize_laplacian(laplacian, mesh.positions, {Precision::kSingle}, work);
  const DenseMatrix solution = solver->solve(rhs.topRows(laplacian.free_count()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (laplacian.row(v) != kNone) uvs[v] = solution.row(laplacian.row(v)).transpose();
  }
}

}  // namespace beltrami
