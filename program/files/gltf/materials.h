// What materials use UVs for.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

/// The numbers of a primitive's material, and of those that KHR_materials_variants has for it.
std::vector<std::uint64_t> materials_of(const Item& primitive);

/// Whether the member `key` of something says how a texture is drawn: by its name, or by the set or
/// the channels that it names.
bool is_texture(const Json& json, std::string_view key);

/// The set of UVs that a texture is drawn through.
std::uint64_t set_of_texture(const Item& texture);

/// The extension of something, if it has it.
std::optional<Item> extension(const Item& item, const char* name);

/// Takes an extension that is used no more off the lists of `json`.
void forget_extension(Json& json, const char* extension_name);

/// The sets of UVs that the normal maps of a primitive's material use, and of the materials that
/// KHR_materials_variants has for it. Throws Failure for a material that is not there.
std::vector<std::uint64_t> sets_of_normal_maps(const Document& document, const Item& primitive);

/// What is drawn through a set of UVs that is replaced.
struct SetUsers {
  std::uint64_t materials = 0;   ///< with textures that use the set
  std::uint64_t transforms = 0;  ///< of KHR_texture_transform that were taken away
  std::set<std::string>
      extensions;  ///< of primitives whose textures use it, but those of materials
};

/// Takes the transforms away from the textures of `json`, an edited copy of the document's, that
/// the materials of these primitives draw through set `uv_set`: UVs made for a whole texture are
/// not to be scaled again. Says who uses the set. What only a material's extras have is not known.
SetUsers free_set_of_textures(const Document& document, const std::vector<Item>& primitives,
                              std::uint64_t uv_set, Json& json);

}  // namespace beltrami::cli::gltf
