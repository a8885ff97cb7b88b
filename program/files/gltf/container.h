// The files that a document is written as.
#pragma once

#include <string>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"
#include "files/gltf/rebuild.h"
#include "files/gltf_file.h"

namespace beltrami::cli::gltf {

/// Where the buffer goes if `document` is written as `path`: to a file of its own, or "". It is the
/// name of `path` with .bin, or where there is such a file the first with a number that is free: so
/// a model that is there stays whole until the new .gltf, which names the new buffer, replaces it.
std::string buffer_path(const Document& document, const std::string& path);

/// Files of such names that the .gltf file now at `path` has its buffers in, and `document` has not
/// unless it is that file. Empty where it cannot be read.
std::vector<std::string> buffers_replaced(const Document& document, const std::string& path);

/// `json`, edited from that of `document`, and its buffer. Throws Failure for what GLB cannot hold.
std::vector<GltfOutput::File> files_of(const Document& document, Json json, Buffer buffer,
                                       const std::string& path);

/// Files that images of the document are in, as far as `json`, edited from its own, still has them,
/// if the paths do not lead to them from `path`.
std::vector<std::string> images_left_behind(const Document& document, const Json& json,
                                            const std::string& path);

}  // namespace beltrami::cli::gltf
