#include "abi/unwrapped.h"

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "abi/joined.h"
#include "abi/reports.h"
#include "abi/surface.h"
#include "atlas/assemble.h"
#include "atlas/atlas.h"
#include "atlas/pages.h"
#include "atlas/seams.h"
#include "base/resources.h"

namespace beltrami {
namespace {

/// Per corner a UV vertex of the atlas: that of a triangle that is judged, if one has the corner,
/// or of one that lies on others, before what was set aside.
std::vector<Index> uvs_of_corners(const LoadedSurface& surface, const Atlas& atlas) {
  std::vector<Index> uv_of_corner(surface.polygons.corners.size(), kNone);
  const std::vector<Triangle>& triangles = surface.triangulation.triangles;
  const auto rank = [&](std::size_t t) {
    return !atlas.excepted[t] ? 0 : atlas.chart_of_face[t] != kNone ? 1 : 2;
  };
  for (const int own : {0, 1, 2}) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (rank(t) != own) continue;
      for (int k = 0; k < 3; ++k) {
        Index& uv = uv_of_corner[triangles[t][k]];
        if (uv == kNone) uv = atlas.faces[t][k];
      }
    }
  }
  return uv_of_corner;
}

/// Gives every triangle the UVs of its corners. Returns whether one that is judged had others:
/// where a polygon is so crooked that its triangles lie in two charts.
bool follow_corners(const LoadedSurface& surface, const std::vector<Index>& uv_of_corner,
                    Atlas& atlas) {
  bool changed = false;
  const std::vector<Triangle>& triangles = surface.triangulation.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Index uv = uv_of_corner[triangles[t][k]];
      changed = changed || (!atlas.excepted[t] && uv != atlas.faces[t][k]);
      atlas.faces[t][k] = uv;
    }
  }
  return changed;
}

/// One UV vertex for each pair of a UV and an input vertex, in the order of the corners.
void split_vertices(const LoadedSurface& surface, const std::vector<Index>& uv_of_corner,
                    Unwrapped& result) {
  const std::vector<Index>& vertex = surface.polygons.corners;
  std::vector<Index> first(result.atlas.uvs.size(), kNone), next;
  result.uv_vertex.reserve(vertex.size());
  for (std::size_t c = 0; c < vertex.size(); ++c) {
    // Few: as many as there are vertices welded to one.
    Index found = first[uv_of_corner[c]];
    while (found != kNone && result.origin[found] != vertex[c]) found = next[found];
    if (found == kNone) {
      found = size_of(result.uvs);
      Vec2 place = result.atlas.uvs[uv_of_corner[c]];
      if (result.atlas.pages) {
        result.page.push_back(result.atlas.page_of_uv[uv_of_corner[c]]);
        place -= tile_of(result.page.back());  // exact: see pack_maps
      }
      result.uvs.push_back(place);
      result.origin.push_back(vertex[c]);
      next.push_back(std::exchange(first[uv_of_corner[c]], found));
    }
    result.uv_vertex.push_back(found);
  }
}

}  // namespace

std::vector<std::uint8_t> diagonals_of(const LoadedSurface& surface) {
  std::vector<std::uint8_t> diagonals(surface.face_of_triangle.size(), 0);
  for (Index t = 0; t < size_of(diagonals); ++t) {
    const Index face = surface.face_of_triangle[t];
    const Index last = surface.polygons.end(face) - surface.polygons.begin(face) - 1;
    const Triangle& corners = surface.triangulation.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const Index apart = std::abs(corners[(k + 1) % 3] - corners[k]);
      if (apart != 1 && apart != last) diagonals[t] |= static_cast<std::uint8_t>(1 << k);
    }
  }
  return diagonals;
}

std::uint64_t Unwrapped::face_of(Index triangle) const {
  if (triangle == kNone || face_of_triangle.empty()) return element_or_none(triangle);
  return static_cast<std::uint64_t>(face_of_triangle[triangle]);
}

Unwrapped unwrap_surfaces(const std::vector<beltrami_surface>& headers, const AtlasOptions& options,
                          bool islands, double hard_angle, const Work& work) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  AtlasProblem problem = read_problem(headers, options, islands, hard_angle, work.named("read"));
  LoadedSurface& surface = problem.surface;
  AtlasOptions with_polygons = options;
  with_polygons.admit.bodies = problem.bodies;
  const std::vector<std::uint8_t> diagonals = diagonals_of(surface);
  with_polygons.admit.polygons = {surface.face_of_triangle, diagonals};

  Unwrapped result;
  result.atlas = unwrap(problem.input, with_polygons, work);
  Atlas& atlas = result.atlas;
  const std::vector<Index> uv_of_corner = uvs_of_corners(surface, atlas);
  if (follow_corners(surface, uv_of_corner, atlas)) {
    judge_atlas(0, options.float32, work.aside(), atlas);
  }
  split_vertices(surface, uv_of_corner, result);
  for (const auto& [a, b] : seams_of(atlas)) result.seams.insert(result.seams.end(), {a, b});
  result.searched = options.target.has_value();
  result.reached = result.searched && meets(atlas, *options.target);

  result.vertices = static_cast<std::uint64_t>(surface.vertex_count);
  result.faces = static_cast<std::uint64_t>(surface.polygons.count());
  result.chart_of_face.assign(static_cast<std::size_t>(surface.polygons.count()), kNone);
  result.triangles = std::move(surface.triangulation.triangles);
  for (Index t = 0; t < size_of(result.triangles); ++t) {
    Index& chart = result.chart_of_face[surface.face_of(t)];
    if (chart == kNone) chart = atlas.chart_of_face[t];
    Triangle& triangle = result.triangles[t];
    if (atlas.reversed[t]) std::swap(triangle[1], triangle[2]);
  }
  result.face_of_triangle = std::move(surface.face_of_triangle);
  result.seconds = wall_seconds() - wall;
  result.cpu_seconds = cpu_seconds() - cpu;
  result.peak_memory_bytes = peak_memory_bytes();
  return result;
}

}  // namespace beltrami
