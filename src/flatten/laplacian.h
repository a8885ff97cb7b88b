// The Laplacian in the metric of Beltrami coefficients (paper section 3.4).
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"

namespace beltrami {

/// The cotangents of the three angles of a face. All that a harmonic map needs to know of it.
struct Cotangents : std::array<double, 3> {};

/// The weights of the edges of a face, each opposite to the corner of its index: its stiffness
/// matrix is that of these springs.
struct EdgeWeights : std::array<double, 3> {};

/// The springs of `scale` times the cotangents: 0.5 makes the cotangent Laplacian.
inline EdgeWeights edge_weights(const Cotangents& cotangents, double scale) {
  return {scale * cotangents[0], scale * cotangents[1], scale * cotangents[2]};
}

/// Cotangents at the three corners of a face in the metric |dz + mu conj(dz)|^2.
/// Precondition: |mu| < 1. (Paper section 3.4: cot = -Re q / Im q with
/// q = (v1 + mu conj(v1)) conj(v2 + mu conj(v2)).)
Cotangents modified_cotangents(const RestTriangle& rest, Complex mu);

/// The same for all faces, with the mu of `metric`.
std::vector<Cotangents> modified_cotangents(const std::vector<RestTriangle>& rest,
                                            const std::vector<FaceMetric>& metric,
                                            const Work& work);

/// Adds the stiffness of one face by add(i, j, block): edge k, opposite to corner k, with
/// weights[k].
template <class Add>
void add_stiffness(const EdgeWeights& weights, const Add& add) {
  for (int k = 0; k < 3; ++k) {
    const int i = next_corner(k), j = previous_corner(k);
    const double at_corner = weights[i] + weights[j], at_edge = -weights[k];
    add(k, k, [=](int, int) { return at_corner; });
    add(i, j, [=](int, int) { return at_edge; });
  }
}

/// The cotangent Laplacian of the free vertices. Negative weights are kept: as the stiffness matrix
/// of a metric it is definite all the same. `pull(row, vertex, weight)` is told of every coupling
/// of a free vertex's row to a fixed vertex, once for each face at their edge.
template <class Pull>
MeshMatrix assemble_laplacian(const Work& work, Index vertex_count,
                              const std::vector<Triangle>& faces,
                              const std::vector<Cotangents>& cotangents,
                              const std::vector<bool>& fixed, Pull&& pull) {
  MeshMatrix laplacian(vertex_count, faces, fixed, 1, work);
  laplacian.add_up(work, faces, [&](Index f, const auto& add) {
    add_stiffness(edge_weights(cotangents[f], 0.5), add);
  });
  for (Index f = 0; f < size_of(faces); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index a = faces[f][next_corner(k)], b = faces[f][previous_corner(k)];
      const Index row_a = laplacian.row(a), row_b = laplacian.row(b);
      if (row_a != kNone && row_b == kNone) pull(row_a, b, 0.5 * cotangents[f][k]);
      if (row_b != kNone && row_a == kNone) pull(row_b, a, 0.5 * cotangents[f][k]);
    }
  }
  return laplacian;
}

/// A factor of an assembled Laplacian of the vertices at `positions`, which help to order it; where
/// rounding left it indefinite, with the least shift of its diagonal that mends it. Throws Error
/// SOLVER where none does.
std::unique_ptr<SpdSolver> factorize_laplacian(MeshMatrix& laplacian,
                                               const std::vector<Vec3>& positions,
                                               const SolverOptions& options, const Work& work);

/// The same with the solver of an earlier Laplacian of the same pattern.
void refactorize_laplacian(SpdSolver& solver, MeshMatrix& laplacian);

}  // namespace beltrami
