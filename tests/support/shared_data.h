// Meshes that are not part of this repository: looked up beside it, and tests do without where they
// are not at hand.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/types.h"
#include "support/meshes.h"

namespace beltrami::shared_data {

inline std::filesystem::path folder() {
  return std::filesystem::path(BELTRAMI_SOURCE_DIR).parent_path() / "shared" / "data";
}

/// Vertices and triangles of an OBJ file.
inline meshes::TriangleList read_obj(const std::filesystem::path& path) {
  meshes::TriangleList mesh;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      double x, y, z;
      words >> x >> y >> z;
      mesh.positions.push_back({x, y, z});
    } else if (kind == "f") {
      Triangle& face = mesh.faces.emplace_back();
      for (Index& vertex : face) {
        std::string corner;  // which may go on with a slash and other numbers
        words >> corner;
        vertex = std::stoi(corner) - 1;
      }
    }
  }
  return mesh;
}

}  // namespace beltrami::shared_data
