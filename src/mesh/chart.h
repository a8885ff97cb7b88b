// A disk of a larger surface.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// A disk and where it comes from. A vertex of the input occurs once for each side of a seam that
/// the disk lies on.
struct Chart {
  DiskMesh mesh;
  std::vector<Index> input_vertex;  ///< per vertex of the mesh
  std::vector<Index> input_face;    ///< per face of the mesh, increasing
};

}  // namespace beltrami
