// The reduced harmonic subspace u = H x: x at the meta vertices, linear between them along the
// boundary, harmonic inside (paper section 3.5).
#pragma once

#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "baselines/reduced/meta_vertices.h"
#include "flatten/laplacian.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Factorizes once; then gives single rows of H, and whole maps. Keeps a reference to the mesh.
class ReducedBasis {
 public:
  /// Harmonic in the metric of the corner `cotangents`. Throws Error SOLVER if the Laplacian is not
  /// definite in floating point.
  ReducedBasis(const DiskMesh& mesh, const std::vector<Cotangents>& cotangents, MetaVertices metas,
               const Work& work);

  const MetaVertices& metas() const { return metas_; }

  /// The rows of H at `vertices`, one column per meta vertex.
  DenseMatrix rows(const std::vector<Index>& vertices) const;

  /// H x for the places x of the meta vertices: one UV per vertex.
  std::vector<Vec2> expand(const std::vector<Vec2>& x) const;

 private:
  const DiskMesh& mesh_;
  MetaVertices metas_;
  std::vector<Index> row_;       // per vertex: its row in the system, kNone on the boundary
  std::vector<Index> position_;  // per vertex: its position in the boundary loop, or kNone
  SparseMatrix pull_;            // right-hand side of the interior, one column per meta vertex
  std::unique_ptr<SpdSolver> solver_;
};

}  // namespace beltrami
