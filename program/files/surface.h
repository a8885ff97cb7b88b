// The triangles that a command computes on, apart from the file that they come from.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// Triangles in someone's memory, as the library and the pictures take them.
struct TriangleView {
  std::span<const double> positions;     ///< x y z per vertex
  std::span<const std::uint32_t> faces;  ///< 3 vertices per triangle
  std::span<const double> uvs;           ///< u v per vertex; empty where there are none yet

  std::uint64_t vertex_count() const { return positions.size() / 3; }
  std::uint64_t face_count() const { return faces.size() / 3; }
};

/// A file's polygons in triangles (triangulate.h), on the file's own vertices. Welded, triangles
/// name the first of the vertices that are at one place (and have one UV, where the file has UVs);
/// the others are left without a triangle, and get their UVs from it.
class Surface {
 public:
  /// `file` must outlive the surface, and keep its positions and polygons.
  Surface(const MeshFile& file, bool weld);
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  /// With the UVs that the file has now.
  TriangleView view() const { return {file_.positions, faces_in_use(), file_.uvs}; }

  /// Vertices that were welded to an earlier one.
  std::uint64_t welded_vertices() const { return welded_; }
  /// Gives welded vertices the UVs of those that they were welded to. `uvs`: u v per vertex.
  void spread_uvs(std::vector<double>& uvs) const;

  /// From now on the polygons of the file are the triangles.
  void follow_file() { faces_.clear(); }

  /// The face of the file that this triangle is a part of.
  std::uint64_t face_of(std::uint64_t triangle) const;

 private:
  std::span<const std::uint32_t> faces_in_use() const {
    return faces_.empty() ? std::span(file_.polygons.corners()) : std::span(faces_);
  }

  const MeshFile& file_;
  std::vector<std::uint32_t> faces_;   ///< empty where the polygons of the file are the triangles
  std::vector<std::uint32_t> vertex_;  ///< the one that each was welded to; empty where none was
  std::uint64_t welded_ = 0;
};

/// Connected components of the triangles.
std::uint64_t component_count(const TriangleView& mesh);

/// Whether `file` is in pieces, and welding makes them one.
bool welding_connects(const MeshFile& file);

}  // namespace beltrami::cli
