// The Laplacian in the metric of Beltrami coefficients (paper section 3.4).
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "beltrami/prolongation.h"
#include "mesh/rest_shape.h"
#include "sparse/mesh_matrix.h"

namespace beltrami {

/// The cotangents of the three angles of a face. All that a harmonic map needs to know of it.
using Cotangents = std::array<double, 3>;

/// Cotangents at the three corners of a face in the metric |dz + mu conj(dz)|^2.
/// Precondition: |mu| < 1. (Paper section 3.4: cot = -Re q / Im q with
/// q = (v1 + mu conj(v1)) conj(v2 + mu conj(v2)).)
Cotangents modified_cotangents(const RestTriangle& rest, Complex mu);

/// The same for all faces, with the mu of `metric`.
std::vector<Cotangents> modified_cotangents(const std::vector<RestTriangle>& rest,
                                            const std::vector<FaceMetric>& metric, int threads);

/// Adds the stiffness of one face: edge k, opposite to corner k, with weights[k].
inline void add_stiffness(MeshMatrix& laplacian, Index face, const Triangle& corners,
                          const std::array<double, 3>& weights) {
  for (int k = 0; k < 3; ++k) {
    const int i = next_corner(k), j = previous_corner(k);
    const double weight = weights[k];
    laplacian.add(face, corners, i, i, [=](int, int) { return weight; });
    laplacian.add(face, corners, j, j, [=](int, int) { return weight; });
    laplacian.add(face, corners, i, j, [=](int, int) { return -weight; });
  }
}

/// The cotangent Laplacian of the free vertices. Negative weights are kept: as the stiffness matrix
/// of a metric it is definite all the same. `pull(row, vertex, weight)` is told of every coupling
/// of a free vertex's row to a fixed vertex, once for each face at their edge.
template <class Pull>
MeshMatrix assemble_laplacian(Index vertex_count, const std::vector<Triangle>& faces,
                              const std::vector<Cotangents>& cotangents,
                              const std::vector<bool>& fixed, Pull&& pull) {
  MeshMatrix laplacian(vertex_count, faces, fixed, 1);
  for (Index f = 0; f < size_of(faces); ++f) {
    std::array<double, 3> weights;
    for (int k = 0; k < 3; ++k) {
      weights[k] = 0.5 * cotangents[f][k];
      const Index a = faces[f][next_corner(k)], b = faces[f][previous_corner(k)];
      const Index row_a = laplacian.row(a), row_b = laplacian.row(b);
      if (row_a != kNone && row_b == kNone) pull(row_a, b, weights[k]);
      if (row_b != kNone && row_a == kNone) pull(row_b, a, weights[k]);
    }
    add_stiffness(laplacian, f, faces[f], weights);
  }
  return laplacian;
}

/// A factor of an assembled Laplacian of the vertices at `positions`, which help to order it; where
/// rounding left it indefinite, with the least shift of its diagonal that mends it. Throws Error
/// SOLVER where none does.
std::unique_ptr<SpdSolver> factorize_laplacian(MeshMatrix& laplacian,
                                               const std::vector<Vec3>& positions,
                                               const SolverOptions& options);

/// The same with the solver of an earlier Laplacian of the same pattern.
void refactorize_laplacian(SpdSolver& solver, MeshMatrix& laplacian);

}  // namespace beltrami
