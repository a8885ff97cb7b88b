// What a document refers to.
#pragma once

#include <cstdint>
#include <vector>

#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

/// Per accessor, and per buffer view: whether anything refers to it.
struct References {
  std::vector<bool> accessors, views;
};

/// References in `json`, buffer views through the accessors that are referred to. What an extension
/// or extras mean is not known: every whole number there counts as a reference of either kind.
References references_in(const Json& json);

}  // namespace beltrami::cli::gltf
