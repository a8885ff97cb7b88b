// The textures of a document's materials: what they show, and new ones in their place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/gltf/item.h"
#include "files/gltf/model.h"
#include "files/gltf/rebuild.h"
#include "files/texture_use.h"

namespace beltrami::cli::gltf {

/// Every texture of the materials that primitives of triangles have, those of extensions among
/// them, once for each way that a material shows it. Of images nothing is read.
std::vector<TextureUse> textures_of(const Model& model);

/// Has the materials of `json`, an edited copy of the document's, show `baked` through set
/// `uv_set`, clamped at the edges. The places of textures and images that nothing refers to any
/// more are taken. Returns the images that are to be in the buffer.
std::vector<NewImage> put_textures(Json& json, const std::vector<BakedTexture>& baked,
                                   std::uint64_t uv_set);

}  // namespace beltrami::cli::gltf
