// A few rings of faces around a place, cut out to be optimised on their own.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// A piece of a mesh with its own vertex numbers. Vertices all of whose faces are in the patch may
/// move, those on the boundary of the mesh too.
struct Patch {
  std::vector<Index> mesh_faces;     ///< increasing
  std::vector<Index> mesh_vertices;  ///< per patch vertex: its number in the mesh, increasing
  std::vector<Triangle> faces;
  std::vector<RestTriangle> rest;
  std::vector<bool> fixed;  ///< per patch vertex; at least one is
  std::vector<Vec2> uvs;
  bool moves_boundary = false;  ///< a vertex on the boundary of the mesh may move

  /// Takes over where its vertices are now.
  void refresh(const std::vector<Vec2>& mesh_uvs);

  /// Swaps the patch's UVs with those of the mesh: once to put them in, twice to undo.
  void exchange(std::vector<Vec2>& mesh_uvs);
};

/// The patch of these faces, in which the vertices `moving` may move; both increasing, and every
/// face of a vertex that may move is among them. `rest` may be empty, and the patch's then is.
Patch make_patch(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                 const std::vector<Vec2>& uvs, std::vector<Index> faces,
                 const std::vector<Index>& moving);

/// Cuts out the faces within `rings` vertex rings of `face`; the rings of hubs, vertices with more
/// than 1000 faces, are left out, and hubs are fixed. `rest` may be empty, and the patch's then is.
Patch cut_patch(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const std::vector<Vec2>& uvs, Index face, int rings);

/// Fixes the vertices on the boundary of the mesh, too.
void hold_boundary(const DiskMesh& mesh, Patch& patch);

}  // namespace beltrami
