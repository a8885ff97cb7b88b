#include "files/surface.h"

#include <algorithm>
#include <numeric>

#include "files/point_numbers.h"
#include "files/polygons.h"
#include "files/triangulate.h"

namespace beltrami::cli {
namespace {

/// Numbers vertices with equal keys by the first of them. `key_of`: a PointNumbers::Point.
template <std::size_t Dimension, class KeyOf>
std::vector<std::uint32_t> first_alike(std::uint64_t vertices, const KeyOf& key_of) {
  PointNumbers<Dimension> points;
  std::vector<std::uint32_t> first, result(vertices);
  for (std::uint32_t i = 0; i < vertices; ++i) {
    const std::uint32_t number = points.number(key_of(i));
    if (number == first.size()) first.push_back(i);
    result[i] = first[number];
  }
  return result;
}

std::vector<std::uint32_t> weld_vertices(const MeshFile& file) {
  const double* p = file.positions.data();
  const double* uv = file.uvs.data();
  if (file.uvs.empty()) {
    return first_alike<3>(file.vertex_count(), [&](std::size_t i) {
      return std::array<double, 3>{p[3 * i], p[3 * i + 1], p[3 * i + 2]};
    });
  }
  return first_alike<5>(file.vertex_count(), [&](std::size_t i) {
    return std::array<double, 5>{p[3 * i], p[3 * i + 1], p[3 * i + 2], uv[2 * i], uv[2 * i + 1]};
  });
}

}  // namespace

Surface::Surface(const MeshFile& file, bool weld) : file_(file) {
  if (!file.polygons.all_triangles()) faces_ = triangulate(file);
  if (!weld) return;
  vertex_ = weld_vertices(file);
  for (std::size_t i = 0; i < vertex_.size(); ++i) welded_ += vertex_[i] != i;
  if (faces_.empty()) faces_ = file.polygons.corners();
  for (std::uint32_t& vertex : faces_) vertex = vertex_[vertex];
}

void Surface::spread_uvs(std::vector<double>& uvs) const {
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) uvs[2 * i + k] = uvs[2 * std::size_t{vertex_[i]} + k];
  }
}

std::uint64_t Surface::face_of(std::uint64_t triangle) const {
  const Polygons& polygons = file_.polygons;
  if (polygons.all_triangles()) return triangle;
  // Every polygon before i gave two triangles less than it has corners.
  std::uint64_t low = 0, high = polygons.size();
  while (high - low > 1) {
    const std::uint64_t i = low + (high - low) / 2;
    (polygons.begin(i) - 2 * i <= triangle ? low : high) = i;
  }
  return low;
}

std::uint64_t component_count(const TriangleView& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<bool> used(mesh.vertex_count(), false);
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      used[mesh.faces[i + k]] = true;
      parent[root(mesh.faces[i + k])] = root(mesh.faces[i]);
    }
  }
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < parent.size(); ++i) count += used[i] && parent[i] == i;
  return count;
}

bool welding_connects(const MeshFile& file) {
  const Surface welded(file, true);
  return welded.welded_vertices() > 0 && component_count(welded.view()) == 1;
}

}  // namespace beltrami::cli
