// Tangents of UVs, as MikkTSpace has them, which glTF names for normal maps.
#pragma once

#include <array>
#include <vector>

namespace beltrami::cli {

/// Of the corners of triangles, three each: x y z, x y z, and u v with the V axis up.
struct CornersWithUvs {
  std::vector<double> positions, normals, uvs;
};

/// x y z and side per corner; 0 0 0 1 where there is none. The axis of u at a corner is the mean
/// over the triangles that meet there with one normal and one UV, by their angles; the side is -1
/// where UVs are mirrored.
std::vector<std::array<double, 4>> corner_tangents(const CornersWithUvs& corners);

}  // namespace beltrami::cli
