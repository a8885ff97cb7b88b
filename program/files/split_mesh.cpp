#include "files/split_mesh.h"

#include <array>
#include <cstddef>

#include "files/point_numbers.h"
#include "files/polygons.h"

namespace beltrami::cli {

SplitMesh::SplitMesh(const MeshFile& file, const std::vector<std::uint32_t>& corners) {
  const std::vector<std::uint32_t>& vertices = file.polygons.corners();
  const auto& [values, of_corner] = file.corner_uvs;
  const bool per_vertex = of_corner.empty();
  PointNumbers<5> points;
  faces_.reserve(corners.size());
  for (const std::uint32_t corner : corners) {
    const double* p = &file.positions[3 * std::size_t{vertices[corner]}];
    const double* uv = per_vertex ? &file.uvs[2 * std::size_t{vertices[corner]}]
                                  : &values[2 * std::size_t{of_corner[corner]}];
    faces_.push_back(points.number({p[0], p[1], p[2], uv[0], uv[1]}));
  }
  const std::vector<double> coordinates = points.take_coordinates();
  for (std::size_t i = 0; i < coordinates.size(); i += 5) {
    positions_.insert(positions_.end(), &coordinates[i], &coordinates[i] + 3);
    uvs_.insert(uvs_.end(), &coordinates[i] + 3, &coordinates[i] + 5);
  }
}

}  // namespace beltrami::cli
