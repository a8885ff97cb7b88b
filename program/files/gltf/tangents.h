// Tangents of new UVs, as MikkTSpace has them, which glTF names for normal maps.
#pragma once

#include <string>
#include <vector>

#include "files/gltf/split.h"
#include "files/mesh_file.h"

namespace beltrami::cli::gltf {

/// Per vertex set, x y z and side of each vertex and copy, in single precision; 1 0 0 1 where it
/// has none. The axis of u at a vertex is the mean over the triangles that meet there with one
/// normal and one UV, by their angles. Precondition: `split` is that of `file`, whose UVs are the
/// new ones.
std::vector<std::string> tangents_of(const MeshFile& file, const Split& split);

}  // namespace beltrami::cli::gltf
