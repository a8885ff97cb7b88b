// From the caller's mesh to a disk, and back to the caller's numbers.
#pragma once

#include <beltrami/beltrami.h>

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Any list of triangles over the vertices that it uses.
struct InputTriangles {
  std::vector<Triangle> faces;  ///< in terms of `original`
  std::vector<Index> original;  ///< per used vertex: its number in the input
};

/// Reads the faces; needs no topology. Throws Error INVALID_ARGUMENT, or INDEX_OUT_OF_RANGE with
/// the face. `mesh` has passed read_mesh_header.
InputTriangles read_triangles(const beltrami_mesh& mesh, const Work& work);

/// A disk over the vertices that the input's faces use.
struct InputDisk {
  DiskMesh disk;
  std::vector<Index> original;       ///< per vertex of `disk`: its number in the input
  std::vector<Index> original_face;  ///< per face of `disk`: likewise
};

/// Reads and validates the caller's mesh, and numbers its vertices and faces by where they are.
/// Throws Error INVALID_ARGUMENT or a mesh status, whose element and message count as the input
/// does. Positions of unused vertices are not looked at.
InputDisk read_disk(const beltrami_mesh& mesh, const Work& work);

/// The same for checks of the topology alone: all positions zero, the order as in the input.
InputDisk read_topology(const beltrami_mesh& mesh, const Work& work);

}  // namespace beltrami
