// Where the nodes of a document put its meshes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "files/gltf/document.h"

namespace beltrami::cli::gltf {

/// Three columns, and the translation.
using Transform = std::array<std::array<double, 3>, 4>;

inline std::array<double, 3> image_of(const Transform& t, const std::array<double, 3>& p) {
  std::array<double, 3> image{};
  for (std::size_t k = 0; k < 3; ++k) {
    image[k] = t[0][k] * p[0] + t[1][k] * p[1] + t[2][k] * p[2] + t[3][k];
  }
  return image;
}

/// Per mesh: the transform to the scene of the first node that shows it and has one that can be
/// inverted. Nothing where there is no such node, and where that node has a skin, whose joints put
/// the mesh elsewhere. Throws Failure for nodes that are not a forest.
std::vector<std::optional<Transform>> mesh_transforms(const Document& document);

}  // namespace beltrami::cli::gltf
