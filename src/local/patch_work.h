// Putting optimised patches back into their mesh.
#pragma once

#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "exact/edge_tree.h"
#include "local/patch.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Keeps references. In between nobody else moves a vertex on the boundary.
class PatchWork {
 public:
  PatchWork(const DiskMesh& mesh, std::vector<Vec2>& uvs) : mesh_(mesh), uvs_(uvs) {}

  /// Puts the patch's UVs in, unless the boundary would cross itself more often; returns whether.
  /// Takes time for the patch and what is near its part of the boundary, not for all of that.
  bool take(Patch& patch);

  /// Lays each part of the mesh's boundary that the patch may move evenly along the straight line
  /// between the boundary vertices at its ends, which it may not.
  void straighten_boundary(Patch& patch);

 private:
  void follow_boundary();
  std::vector<Index> moving_edges(const Patch& patch) const;
  std::int64_t crossings_of(const std::vector<Index>& edges);
  void exchange(Patch& patch, const std::vector<Index>& edges);

  const DiskMesh& mesh_;
  std::vector<Vec2>& uvs_;
  // Of the boundary, once a patch moves it: see follow_boundary.
  std::optional<EdgeTree> tree_;
  std::vector<Index> position_;  ///< per vertex
};

}  // namespace beltrami
