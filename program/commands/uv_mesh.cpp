#include "commands/uv_mesh.h"

#include <cstddef>

#include "files/point_numbers.h"
#include "files/polygons.h"

namespace beltrami::cli {

UvMesh uv_mesh_of(const MeshFile& file, const std::vector<std::uint32_t>& corners) {
  UvMesh mesh;
  const auto& [values, of_corner] = file.corner_uvs;
  PointNumbers<5> points;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t vertex = file.polygons.corners()[corner];
    const double* p = &file.positions[3 * std::size_t{vertex}];
    const double* uv = of_corner.empty() ? &file.uvs[2 * std::size_t{vertex}]
                                         : &values[2 * std::size_t{of_corner[corner]}];
    mesh.uv_indices.push_back(points.number({p[0], p[1], p[2], uv[0], uv[1]}));
    mesh.vertices.push_back(vertex);
  }
  const std::vector<double> numbers = points.take_coordinates();
  for (std::size_t i = 0; i < numbers.size(); i += 5) {
    mesh.uvs.insert(mesh.uvs.end(), {numbers[i + 3], numbers[i + 4]});
  }
  return mesh;
}

}  // namespace beltrami::cli
