// What simplifying leaves.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/history.h"

namespace beltrami {

/// A coarse disk whose vertices are a subset of the fine ones, the boundary loop in the same order.
struct CoarseDisk {
  DiskMesh mesh;
  std::vector<Index> fine_vertex;  ///< per coarse vertex: the fine vertex that it is
  std::vector<Index> nearby;  ///< per fine vertex: the coarse vertex that it was collapsed into
};

/// A coarse surface whose vertices are a subset of the fine ones, and the way back.
struct CoarseSurface {
  Surface mesh;
  std::vector<Index> fine_vertex;  ///< per coarse vertex: the fine vertex that it is
  std::vector<Index> fine_face;    ///< per coarse face: the fine face that it was, increasing
  CollapseHistory history;
};

}  // namespace beltrami
