#include "atlas/quad_grid.h"

#include <array>
#include <cstddef>
#include <utility>

#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

/// The quads of a chart, by the half-edges of their sides.
class Quads {
 public:
  /// `quad`: per face of the mesh.
  Quads(const DiskMesh& mesh, const std::vector<Index>& quad) : mesh_(mesh), quad_(quad) {}

  bool is_side(Index h) const {
    return mesh_.twin[h] == kNone || quad_[mesh_.twin[h] / 3] != quad_[h / 3];
  }
  /// The next side of the same quad.
  Index next(Index h) const {
    Index n = Surface::next(h);
    while (!is_side(n)) n = Surface::next(mesh_.twin[n]);
    return n;
  }
  Index opposite(Index h) const { return next(next(h)); }
  /// Whether every face is half of a quad whose halves share their diagonal.
  bool all_are_pairs() const {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      int sides = 0;
      for (int k = 0; k < 3; ++k) sides += is_side(3 * f + k) ? 1 : 0;
      if (sides != 2) return false;
    }
    return true;
  }

 private:
  const DiskMesh& mesh_;
  const std::vector<Index>& quad_;
};

/// A half-edge from a vertex of one quad, the surface on its left; kNone where the quads do not
/// meet as those of a grid: four at a vertex, two at one of the border, and one at just four of
/// these.
Index first_corner(const DiskMesh& mesh, const Quads& quads) {
  std::vector<int> quads_at(mesh.positions.size(), 0);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    if (quads.is_side(h)) ++quads_at[mesh.origin(h)];
  }
  int corners = 0;
  Index first = kNone;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const int expected = mesh.on_boundary[v] ? 2 : 4;
    if (quads_at[v] == expected) continue;
    if (!mesh.on_boundary[v] || quads_at[v] != 1) return kNone;
    ++corners;
    if (first == kNone) first = mesh.outgoing[v];
  }
  return corners == 4 ? first : kNone;
}

/// Of the edges across each column or row.
class Spacing {
 public:
  void add(std::size_t i, double length) {
    if (i == sums_.size()) sums_.push_back({});
    sums_[i].first += length;
    ++sums_[i].second;
  }
  /// Where the lines between them lie; none where one has no extent.
  std::vector<double> lines() const {
    std::vector<double> lines{0};
    for (const auto& [sum, count] : sums_) {
      const double next = lines.back() + sum / count;
      if (!(next > lines.back())) return {};
      lines.push_back(next);
    }
    return lines;
  }

 private:
  std::vector<std::pair<double, int>> sums_;
};

}  // namespace

std::optional<std::vector<Vec2>> grid_map(const AtlasChart& part, const Admitted& admitted,
                                          std::span<const Index> polygons) {
  const DiskMesh& mesh = part.chart.mesh;
  if (polygons.empty() || part.real_faces != mesh.face_count()) return std::nullopt;
  std::vector<Index> quad;
  quad.reserve(mesh.faces.size());
  for (const Index own : part.chart.input_face) quad.push_back(polygons[admitted.input_face[own]]);
  const Quads quads(mesh, quad);
  if (!quads.all_are_pairs()) return std::nullopt;
  const Index corner = first_corner(mesh, quads);
  if (corner == kNone) return std::nullopt;

  const auto length = [&](Index h) {
    return (mesh.positions[mesh.target(h)] - mesh.positions[mesh.origin(h)]).norm();
  };
  std::vector<std::array<Index, 2>> place(mesh.positions.size(), {kNone, kNone});
  Spacing columns, rows;
  Index visited = 0, j = 0;
  for (Index row = corner; row != kNone; ++j) {
    Index i = 0;
    for (Index bottom = row; bottom != kNone; ++i) {
      const Index right = quads.next(bottom), top = quads.next(right), left = quads.next(top);
      const std::array<std::pair<Index, std::array<Index, 2>>, 4> corners{
          {{bottom, {i, j}}, {right, {i + 1, j}}, {top, {i + 1, j + 1}}, {left, {i, j + 1}}}};
      for (const auto& [h, at] : corners) {
        std::array<Index, 2>& known = place[mesh.origin(h)];
        if (known[0] != kNone && known != at) return std::nullopt;
        known = at;
      }
      columns.add(i, length(bottom));
      rows.add(j, length(left));
      if (mesh.twin[top] == kNone) columns.add(i, length(top));
      if (mesh.twin[right] == kNone) rows.add(j, length(right));
      if (++visited > mesh.face_count()) return std::nullopt;
      const Index beside = mesh.twin[right];
      bottom = beside == kNone ? kNone : quads.next(beside);
    }
    row = mesh.twin[quads.opposite(row)];
  }
  if (2 * visited != mesh.face_count()) return std::nullopt;
  const std::vector<double> us = columns.lines(), vs = rows.lines();
  if (us.empty() || vs.empty()) return std::nullopt;
  std::vector<Vec2> uvs;
  uvs.reserve(place.size());
  for (const auto& [i, row] : place) uvs.push_back({us[i], vs[row]});
  return uvs;
}

}  // namespace beltrami
