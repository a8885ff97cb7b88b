// What materials use UVs for.
#pragma once

#include <cstdint>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

/// The sets of UVs that the normal maps of a primitive's material use, and of the materials that
/// KHR_materials_variants has for it. Throws Failure for a material that is not there.
std::vector<std::uint64_t> sets_of_normal_maps(const Document& document, const Item& primitive);

}  // namespace beltrami::cli::gltf
