// A mesh with a vertex for each UV that a vertex has: what pictures and measures take.
#pragma once

#include <cstdint>
#include <vector>

#include "files/mesh_file.h"
#include "files/surface.h"

namespace beltrami::cli {

/// Corners at one place, in space and in the plane, are one vertex.
class SplitMesh {
 public:
  /// `corners`: three corners of the file's faces for each triangle. The file has UVs.
  SplitMesh(const MeshFile& file, const std::vector<std::uint32_t>& corners);

  TriangleView view() const { return {positions_, faces_, uvs_}; }

 private:
  std::vector<double> positions_, uvs_;
  std::vector<std::uint32_t> faces_;
};

}  // namespace beltrami::cli
