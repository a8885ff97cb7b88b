#include "files/gltf/tangents.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/corner_tangents.h"
#include "files/gltf/little.h"
#include "files/gltf/model.h"
#include "files/gltf_file.h"
#include "files/polygons.h"

namespace beltrami::cli::gltf {
namespace {

CornersWithUvs corners_of(const MeshFile& file, const std::vector<double>& normals) {
  CornersWithUvs corners;
  const std::vector<double> positions = gltf_attribute(file, "POSITION", 3);
  const auto& [values, of_corner] = file.corner_uvs;
  const std::vector<std::uint32_t>& vertices = file.polygons.corners();
  for (std::size_t c = 0; c < vertices.size(); ++c) {
    const std::size_t vertex = vertices[c];
    for (std::size_t k = 0; k < 3; ++k) {
      corners.positions.push_back(positions[3 * vertex + k]);
      corners.normals.push_back(normals[3 * vertex + k]);
    }
    const double* uv =
        of_corner.empty() ? &file.uvs[2 * vertex] : &values[2 * std::size_t{of_corner[c]}];
    corners.uvs.insert(corners.uvs.end(), {uv[0], uv[1]});
  }
  return corners;
}

}  // namespace

std::vector<std::string> tangents_of(const MeshFile& file, const Split& split) {
  const Model& model = model_of(file);
  std::vector<std::vector<std::array<float, 4>>> found;
  for (std::size_t set = 0; set < model.sets.size(); ++set) {
    found.emplace_back(model.sets[set].count + split.copies[set].size(),
                       std::array<float, 4>{1, 0, 0, 1});
  }
  const std::vector<double> normals = gltf_attribute(file, "NORMAL", 3);
  std::vector<std::array<double, 4>> tangents;
  if (!normals.empty()) tangents = corner_tangents(corners_of(file, normals));
  for (const Primitive& place : model.primitives) {
    const std::uint64_t first = 3 * place.first_face;
    for (std::uint64_t c = first; c < first + 3 * place.face_count && !tangents.empty(); ++c) {
      const auto [x, y, z, side] = tangents[c];
      // Where there is no normal, there is none across it.
      if (!(x * x + y * y + z * z > 0)) continue;
      found[place.set][split.corners[c]] = {static_cast<float>(x), static_cast<float>(y),
                                            static_cast<float>(z), static_cast<float>(side)};
    }
  }
  std::vector<std::string> bytes(found.size());
  for (std::size_t set = 0; set < found.size(); ++set) {
    for (const std::array<float, 4>& tangent : found[set]) {
      for (const float x : tangent) append_little(bytes[set], x);
    }
  }
  return bytes;
}

}  // namespace beltrami::cli::gltf
