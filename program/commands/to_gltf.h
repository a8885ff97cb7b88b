// A mesh of another format as a glTF document.
#pragma once

#include <cstdint>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

struct AsGltf {
  MeshFile file;
  std::vector<std::uint64_t> polygons;  ///< per triangle of `file` the polygon that it is of
};

/// `mesh` as read_gltf gives it, for glTF to be written: one mesh of triangles with a primitive for
/// each material, positions in single precision, normals, and of vertices their colours. Of an OBJ
/// file the UVs and materials of its libraries come along where these have textures, with images in
/// the document: Kd, Ke, d, Pr, Pm, Ns, map_Kd, map_Ke, and map_Bump or norm where they hold
/// directions. What does not is said in not_kept. `content` is what is read of the document; kAll
/// wants UVs. Throws Failure for coordinates that are not finite, and as triangulate() does.
AsGltf as_gltf(const MeshFile& mesh, Content content);

}  // namespace beltrami::cli
