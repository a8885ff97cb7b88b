// Vertices with several UVs become several vertices.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli::gltf {

struct Split {
  /// Per set: which vertex each of those behind the old ones is a copy of.
  std::vector<std::vector<std::uint32_t>> copies;
  /// Per set: the UVs as glTF holds them, of old vertices and copies; 0 0 where no face is.
  std::vector<std::string> uvs;
  /// Per corner of the file: the vertex in its set, an old one or a copy.
  std::vector<std::uint32_t> corners;
};

/// The first corner at a vertex keeps it; the first with each other UV vertex makes a copy.
/// std::bad_alloc.
/// Precondition: `file` has UVs.
Split split_vertices(const MeshFile& file);

}  // namespace beltrami::cli::gltf
