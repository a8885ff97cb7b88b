#include "session/stack.h"

#include <utility>

#include "atlas/congruent.h"
#include "mesh/disk_mesh.h"
#include "session/carry.h"

namespace beltrami {
ChartShape shape_of(const AtlasChart& chart, const Work& work) {
  const DiskMesh& mesh = chart.chart.mesh;
  SurfacePiece piece;
  piece.real_faces = chart.real_faces;
  piece.surface.positions = mesh.positions;
  piece.surface.faces.assign(mesh.faces.begin(), mesh.faces.begin() + chart.real_faces);
  piece.surface.twin.assign(mesh.twin.begin(), mesh.twin.begin() + 3 * chart.real_faces);
  for (Index& twin : piece.surface.twin) {
    if (twin >= 3 * chart.real_faces) twin = kNone;
  }
  piece.exponent = bring_to_unit(piece.surface, work);
  return {&chart, std::move(piece)};
}

std::optional<std::vector<Index>> vertices_on(const ChartShape& shape, const ChartShape& other) {
  if (shape.piece.real_faces != other.piece.real_faces) return std::nullopt;
  const std::optional<Laid> laid = laid_onto(shape.piece, other.piece, false);
  if (!laid) return std::nullopt;
  const DiskMesh &mesh = shape.chart->chart.mesh, &below = other.chart->chart.mesh;
  std::vector<Index> vertices(mesh.positions.size(), kNone);
  for (Index h = 0; h < size_of(laid->onto); ++h) {
    vertices[mesh.origin(h)] = below.origin(laid->onto[h]);
  }
  return vertices;
}

std::vector<Vec2> map_on(const AtlasChart& chart, const std::vector<Index>& vertices,
                         const std::vector<Vec2>& uvs_of_other) {
  std::vector<Vec2> uvs(vertices.size(), Vec2::Zero());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v] != kNone) uvs[v] = uvs_of_other[vertices[v]];
  }
  place_virtual(chart, uvs);
  return uvs;
}

}  // namespace beltrami
