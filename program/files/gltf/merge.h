// Several materials of a document made one.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/gltf/item.h"
#include "files/gltf/model.h"
#include "files/texture_use.h"

namespace beltrami::cli::gltf {

/// Materials that become one: the first of them.
struct MergedMaterial {
  std::vector<std::uint64_t> members;
  Json json;  ///< without the textures that are baked
};

struct MergePlan {
  std::vector<MergedMaterial> materials;
  std::vector<MergedTexture> textures;
  std::string note;  ///< what keeps them apart, or ""
};

/// What becomes of the materials that primitives of triangles have. Throws Failure for a document
/// with variants of materials.
MergePlan merge_plan(const Model& model);

/// Gives the primitives of `json`, an edited copy of the document's, the merged materials, which
/// are without pictures yet.
void merge_materials(Json& json, const Model& model, const MergePlan& plan);

/// Takes the materials away that merging has left without use, once the others have their pictures.
/// Where something that is not known here may have their numbers, they stay as copies instead.
void drop_merged(Json& json, const MergePlan& plan);

}  // namespace beltrami::cli::gltf
