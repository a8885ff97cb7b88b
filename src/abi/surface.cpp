#include "abi/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/interrupt.h"

namespace beltrami {
namespace {

constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();
constexpr std::uint64_t kMaxTriangles = 700'000'000;  // 3 half-edges each fit an Index

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

bool is_given(const beltrami_buffer& buffer) {
  return buffer.data != nullptr;
}

/// The end of the corners of each face. Throws Error INVALID_ARGUMENT with the face.
std::vector<Index> read_ends(const beltrami_surface& header, const Work& work) {
  const std::vector<std::uint64_t> sizes =
      read_integers(header.face_sizes, header.face_count, 1, "face sizes", work);
  std::vector<Index> ends;
  ends.reserve(sizes.size());
  std::uint64_t end = 0;
  for (std::size_t f = 0; f < sizes.size(); ++f) {
    if (sizes[f] < 3 || sizes[f] > header.corner_count - end) {
      throw Error(Fault::kInvalidArgument,
                  "face " + std::to_string(f) + " has " + std::to_string(sizes[f]) + " corners: " +
                      (sizes[f] < 3 ? "a face has 3 or more"
                                    : "with it there are more than corner_count says"),
                  Element::face(f));
    }
    end += sizes[f];
    ends.push_back(static_cast<Index>(end));
  }
  if (end != header.corner_count) {
    refuse("the faces have " + std::to_string(end) + " corners, and corner_count says " +
           std::to_string(header.corner_count));
  }
  return ends;
}

/// The vertex of each corner. Throws Error INDEX_OUT_OF_RANGE with the face.
std::vector<Index> to_vertices(const std::vector<std::uint64_t>& indices, const Polygons& shape,
                               std::uint64_t vertex_count) {
  std::vector<Index> corners(indices.size());
  PollSometimes poll;
  for (std::size_t c = 0; c < indices.size(); ++c) {
    poll();
    if (indices[c] >= vertex_count) {
      const auto corner = static_cast<Index>(c);
      const std::size_t face =
          shape.all_triangles()
              ? c / 3
              : static_cast<std::size_t>(
                    std::upper_bound(shape.ends.begin(), shape.ends.end(), corner) -
                    shape.ends.begin());
      throw Error(Fault::kIndexOutOfRange,
                  "face " + std::to_string(face) + " names vertex " + std::to_string(indices[c]) +
                      ", but there are " + std::to_string(vertex_count) +
                      " vertices: indices count from 0",
                  Element::face(face));
    }
    corners[c] = static_cast<Index>(indices[c]);
  }
  return corners;
}

Polygons read_polygons(const beltrami_surface& header, const Work& work) {
  Polygons polygons;
  const bool triangles = !is_given(header.face_sizes);
  if (!triangles) polygons.ends = read_ends(header, work);
  const std::vector<std::uint64_t> indices =
      triangles ? read_integers(header.indices, header.face_count, 3, "indices", work)
                : read_integers(header.indices, header.corner_count, 1, "indices", work);
  polygons.corners = to_vertices(indices, polygons, header.vertex_count);
  return polygons;
}

/// Throws Error NON_FINITE with the first such vertex of a face; others become zero.
void require_finite_where_used(const Polygons& polygons, std::vector<Vec3>& positions) {
  std::vector<bool> used(positions.size(), false);
  for (const Index v : polygons.corners) used[v] = true;
  PollSometimes poll;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    poll();
    if (positions[v].allFinite()) continue;
    if (used[v]) {
      throw Error(
          Fault::kNonFinite,
          "vertex " + std::to_string(v) + " has a coordinate that is infinite or not a number",
          Element::vertex(v));
    }
    positions[v].setZero();
  }
}

void triangulate(LoadedSurface& surface, const Work& work) {
  surface.triangulation = triangulate(surface.positions, surface.polygons, work);
  if (surface.polygons.all_triangles()) return;
  surface.face_of_triangle.reserve(surface.triangulation.triangles.size());
  for (Index f = 0; f < surface.polygons.count(); ++f) {
    const Index corners = surface.polygons.end(f) - surface.polygons.begin(f);
    surface.face_of_triangle.insert(surface.face_of_triangle.end(), corners - 2, f);
  }
}

enum class Positions { kAny, kFinite };

/// With the positions that are given, or zeros.
LoadedSurface read(const beltrami_surface& header, bool needs_positions, Positions positions,
                   const Work& work) {
  LoadedSurface surface;
  surface.vertex_count = static_cast<Index>(header.vertex_count);
  surface.polygons = read_polygons(header, work);
  surface.positions.assign(header.vertex_count, Vec3::Zero());
  if (needs_positions || is_given(header.positions)) {
    const std::vector<double> numbers =
        read_numbers(header.positions, header.vertex_count, 3, "positions", work);
    for (std::size_t v = 0; v < surface.positions.size(); ++v) {
      surface.positions[v] = {numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]};
    }
  }
  if (positions == Positions::kFinite) {
    require_finite_where_used(surface.polygons, surface.positions);
  }
  triangulate(surface, work);
  return surface;
}

std::vector<double> read_densities(const beltrami_surface& header, const Work& work) {
  std::vector<double> densities =
      read_numbers(header.densities, header.face_count, 1, "densities", work);
  for (std::size_t f = 0; f < densities.size(); ++f) {
    if (densities[f] > 0 && std::isfinite(densities[f])) continue;
    throw Error(Fault::kInvalidArgument,
                "the density of face " + std::to_string(f) + " is no finite number above 0",
                Element::face(f));
  }
  return densities;
}

std::vector<std::array<Index, 2>> read_seams(const beltrami_surface& header, const Work& work) {
  const std::vector<std::uint64_t> ends =
      read_integers(header.seams, header.seam_count, 2, "seams", work);
  std::vector<std::array<Index, 2>> seams;
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    for (const std::uint64_t vertex : {ends[i], ends[i + 1]}) {
      if (vertex < header.vertex_count) continue;
      throw Error(Fault::kIndexOutOfRange, "seam " + std::to_string(i / 2) + " names vertex " +
                                               std::to_string(vertex) + ", but there are " +
                                               std::to_string(header.vertex_count) +
                                               " vertices: indices count from 0");
    }
    seams.push_back({static_cast<Index>(ends[i]), static_cast<Index>(ends[i + 1])});
  }
  return seams;
}

}  // namespace

beltrami_surface read_surface_header(const beltrami_surface* theirs) {
  beltrami_surface header = read_sized(theirs, "the surface");
  if (header.flags != 0) refuse("the field `flags` of the surface is not 0");
  if (header.vertex_count == 0 || header.face_count == 0) {
    throw Error(Fault::kEmpty, "the surface has no vertices or no faces: there is nothing to do");
  }
  if (!is_given(header.face_sizes)) {
    if (header.corner_count != 0 && header.corner_count != 3 * header.face_count) {
      refuse("corner_count is " + std::to_string(header.corner_count) +
             ": without face_sizes all faces are triangles, and it is 3 * face_count or 0");
    }
    header.corner_count = 3 * header.face_count;
  }
  if (header.vertex_count > kMaxVertices || header.face_count > kMaxTriangles ||
      header.corner_count > 3 * kMaxTriangles ||
      header.corner_count > kMaxTriangles + 2 * header.face_count) {
    refuse("the surface has " + std::to_string(header.vertex_count) + " vertices, " +
           std::to_string(header.face_count) + " faces and " + std::to_string(header.corner_count) +
           " corners: at most " + std::to_string(kMaxVertices) + " vertices and " +
           std::to_string(kMaxTriangles) + " triangles are possible");
  }
  return header;
}

LoadedSurface read_surface(const beltrami_surface& header, const Work& work) {
  return read(header, true, Positions::kFinite, work);
}

LoadedSurface read_surface_to_check(const beltrami_surface& header, const Work& work) {
  return read(header, is_given(header.face_sizes), Positions::kFinite, work);
}

LoadedSurface read_surface_to_triangulate(const beltrami_surface& header, const Work& work) {
  return read(header, is_given(header.face_sizes), Positions::kAny, work);
}

std::vector<Triangle> triangles_of(const LoadedSurface& surface) {
  std::vector<Triangle> triangles = surface.triangulation.triangles;
  for (Triangle& triangle : triangles) {
    for (Index& corner : triangle) corner = surface.polygons.corners[corner];
  }
  return triangles;
}

std::vector<Vec2> read_corner_uvs(const beltrami_surface& header, const LoadedSurface& surface,
                                  const Work& work) {
  if (!is_given(header.corner_uvs)) refuse("the surface has no corner_uvs");
  const std::vector<double> numbers =
      read_numbers(header.corner_uvs, header.corner_count, 2, "corner UVs", work);
  std::vector<Vec2> uvs;
  uvs.reserve(header.corner_count);
  for (Index f = 0; f < surface.polygons.count(); ++f) {
    for (Index c = surface.polygons.begin(f); c < surface.polygons.end(f); ++c) {
      uvs.emplace_back(numbers[2 * static_cast<std::size_t>(c)],
                       numbers[2 * static_cast<std::size_t>(c) + 1]);
      if (uvs.back().allFinite()) continue;
      throw Error(Fault::kNonFinite,
                  "a UV of face " + std::to_string(f) + " is infinite or not a number",
                  Element::face(static_cast<std::uint64_t>(f)));
    }
  }
  return uvs;
}

std::vector<Index> dense(const std::vector<std::uint64_t>& labels) {
  std::vector<std::uint64_t> values = labels;
  sort_interruptibly(values.begin(), values.end(), std::less<>());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<Index> numbers;
  numbers.reserve(labels.size());
  for (const std::uint64_t label : labels) {
    numbers.push_back(
        static_cast<Index>(std::lower_bound(values.begin(), values.end(), label) - values.begin()));
  }
  return numbers;
}

AtlasInput atlas_input(const beltrami_surface& header, const LoadedSurface& surface, bool islands,
                       const Work& work) {
  AtlasInput input;
  input.positions = surface.positions;
  input.faces = triangles_of(surface);
  const Index triangles = size_of(input.faces);
  const auto per_triangle = [&](const auto& of_faces, auto& result) {
    result.reserve(triangles);
    for (Index t = 0; t < triangles; ++t) result.push_back(of_faces[surface.face_of(t)]);
  };
  if (is_given(header.seams) || header.seam_count > 0) {
    input.cuts.edges = read_seams(header, work);
  }
  if (is_given(header.face_labels)) {
    per_triangle(read_integers(header.face_labels, header.face_count, 1, "face labels", work),
                 input.cuts.labels);
  }
  if (is_given(header.densities)) per_triangle(read_densities(header, work), input.densities);
  if (islands) {
    const std::vector<Vec2> uvs = read_corner_uvs(header, surface, work);
    input.cuts.corner_uvs.reserve(3 * static_cast<std::size_t>(triangles));
    for (const Triangle& triangle : surface.triangulation.triangles) {
      for (const Index corner : triangle) input.cuts.corner_uvs.push_back(uvs[corner]);
    }
  }
  return input;
}

}  // namespace beltrami
