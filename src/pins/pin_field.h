// Displacements of a few vertices, carried on to all others of a map.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "linear/mesh_matrix.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Of a few pinned vertices as a deformation of the plane: the affine map that fits them best or
/// their mean shift, and a sum of cones around them for the rest, whose slopes do not depend on how
/// fine the mesh is. Of many the one that is harmonic on the mesh, which hugs each vertex.
class PinField {
 public:
  /// `pins`: vertices, each once. Keeps references.
  PinField(const DiskMesh& mesh, const std::vector<Index>& pins, const Work& work);

  /// One displacement per vertex; those of the pins are the `displacements` themselves. `uvs`:
  /// where the vertices are. Of the affine map and the shift that is taken whose map has the less
  /// `energy`: pins near each other determine an affine map that shears all the rest. Precondition:
  /// no two pins at one place. Throws Error SOLVER.
  std::vector<Vec2> extend(const std::vector<Vec2>& uvs, const std::vector<Vec2>& displacements,
                           const std::function<double(const std::vector<Vec2>&)>& energy);

  /// Any vectors at the pins, and everywhere else the mean of the neighbours. Throws Error SOLVER.
  std::vector<Vec2> harmonic(const std::vector<Vec2>& displacements);

 private:
  std::vector<Vec2> by_cones(const std::vector<Vec2>& uvs, std::vector<Vec2> displacements,
                             bool affinely) const;

  const DiskMesh& mesh_;
  const std::vector<Index>& pins_;
  const Work work_;
  std::unique_ptr<MeshMatrix> laplacian_;  // from its first use on
  std::unique_ptr<SpdSolver> solver_;
};

}  // namespace beltrami
