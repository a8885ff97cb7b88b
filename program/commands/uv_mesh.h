// Triangles in the plane, as beltrami_pack takes them.
#pragma once

#include <cstdint>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// Per corner of triangles: its UV vertex, and its vertex in the file. Corners at one place in
/// space with one UV share a UV vertex, however the file numbers them: where they do not, charts
/// end.
struct UvMesh {
  std::vector<double> uvs;  ///< u v of each UV vertex
  std::vector<std::uint32_t> uv_indices, vertices;
};

/// `corners`: of the file's faces, three for each triangle. The file has UVs.
UvMesh uv_mesh_of(const MeshFile& file, const std::vector<std::uint32_t>& corners);

}  // namespace beltrami::cli
