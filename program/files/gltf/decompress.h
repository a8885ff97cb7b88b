// Meshes that extensions have compressed become plain ones.
#pragma once

#include "files/gltf/document.h"
#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

/// Whether a buffer has no bytes, and stands for those that views are decoded to.
bool is_fallback(const Item& buffer);

/// Decodes the views of EXT_meshopt_compression and the primitives of KHR_draco_mesh_compression
/// into a new buffer. Afterwards the document has neither extension, and says in not_kept what it
/// had. Throws Failure for what is damaged, and where this build lacks a decoder.
void decompress(Document& document);

}  // namespace beltrami::cli::gltf
