// What a fine mesh has and a coarse one of its shape has not, in pictures for the coarse one's UVs.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "commands/bake_call.h"
#include "files/mesh_file.h"
#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

enum class Detail {
  kNormals,  ///< along the tangents of the coarse mesh, as glTF has them
  kHeights   ///< along its normals
};

/// "normals" or "heights"; nothing for other words.
std::optional<Detail> detail_named(const std::string& word);

/// Corners of triangles: x y z each.
struct DetailMesh {
  std::vector<double> places, normals;
};

/// The corners of `triangles`, corners of the file's faces, with the normals that the file has; one
/// without gets those of a smooth surface. Throws Failure for glTF whose nodes move its meshes.
DetailMesh detail_mesh(const MeshFile& file, const std::vector<std::uint32_t>& triangles);

/// Where the triangles of the coarse mesh are on the pages.
struct DetailLayout {
  std::vector<double> uvs;           ///< u v of each corner
  std::vector<std::uint64_t> pages;  ///< of each triangle
  std::uint64_t page_count = 1;
  int side = 0;
};

struct DetailPages {
  std::vector<Pixels> pages;  ///< in single precision: three components of directions, or one
  BakeOutcome outcome;
};

/// Bakes what the nearest places of `fine` have that look the same way. Directions go from 0 to 1
/// with 0.5 for none, heights are in units of the mesh.
DetailPages bake_detail(Detail detail, const DetailMesh& fine, const DetailMesh& coarse,
                        const DetailLayout& layout, beltrami_context* context,
                        const std::string& name);

/// The pages with 16 bits for each component; `scale` is the height that 1 stands for where 0.5 is
/// none, the largest of all pages, or 0 for directions.
std::vector<Pixels> in_16_bits(const std::vector<Pixels>& pages, Detail detail, double& scale);

}  // namespace beltrami::cli
