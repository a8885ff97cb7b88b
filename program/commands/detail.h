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
  kNormals,   ///< along the tangents of the coarse mesh, as glTF has them
  kHeights,   ///< along its normals
  kOcclusion  ///< how much of a grey sky the fine mesh sees
};

/// "normals", "heights" or "occlusion"; nothing for other words.
std::optional<Detail> detail_named(const std::string& word);

/// Corners of triangles: x y z each.
struct DetailMesh {
  std::vector<double> places, normals;
  std::vector<double> smooth;  ///< normals by the faces around a place, whatever the file says
};

/// The corners of `triangles`, corners of the file's faces, with the normals that the file has; one
/// without gets those of a smooth surface. Throws Failure for glTF whose nodes move its meshes.
DetailMesh detail_mesh(const MeshFile& file, const std::vector<std::uint32_t>& triangles);

/// Some of its triangles.
DetailMesh part_of(const DetailMesh& mesh, const std::vector<std::size_t>& triangles);

/// Per corner of triangles, x y z: the mean of the triangles at its place, by their areas.
std::vector<double> smooth_normals(const std::vector<double>& places);

/// What is baked, and how it is looked for.
struct DetailLooks {
  Detail detail = Detail::kNormals;
  double cage = 0;         ///< 0: by the nearest places
  std::uint64_t rays = 0;  ///< to the sky; 0: as many as usual
  int side = 0;            ///< texels of a page
};

struct DetailPage {
  Pixels page;  ///< in single precision: three components of directions, or one
  BakeOutcome outcome;
};

/// Bakes one page, of the triangles of `coarse` with their `uvs`, u v of each corner. Directions go
/// from 0 to 1 with 0.5 for none, heights are in units of the mesh, the sky is from 0 to 1.
DetailPage bake_detail(const DetailLooks& looks, const DetailMesh& fine, const DetailMesh& coarse,
                       const std::vector<double>& uvs, beltrami_context* context,
                       const std::string& name);

/// The largest number of a page, without its sign.
double greatest(const Pixels& page);

/// A page with 16 bits for each component, or 8 for occlusion; `scale` is the height that 1 stands
/// for where 0.5 is none.
Pixels in_whole_numbers(const Pixels& page, Detail detail, double scale);

}  // namespace beltrami::cli
