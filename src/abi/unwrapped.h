// An atlas in the numbers of the caller's corners.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "abi/surface.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// What beltrami_unwrap leaves behind.
struct Unwrapped {
  Atlas atlas;  ///< of the triangles
  std::uint64_t vertices = 0, faces = 0;
  std::vector<Triangle> triangles;      ///< their corners, as they were oriented
  std::vector<Index> face_of_triangle;  ///< empty where all faces are triangles
  std::vector<Index> chart_of_face;

  /// Vertices split along seams: one for each UV that an input vertex has.
  std::vector<Vec2> uvs;         ///< where they are packed, on their page
  std::vector<Index> page;       ///< per UV vertex, where they are packed
  std::vector<Index> origin;     ///< per UV vertex the input vertex
  std::vector<Index> uv_vertex;  ///< per corner
  std::vector<Index> seams;      ///< two input vertices each, see seams_of
  bool searched = false;         ///< whether seams were searched for,
  bool reached = false;          ///< and meet what was asked for
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory_bytes = 0;

  /// The caller's face, or BELTRAMI_NO_ELEMENT.
  std::uint64_t face_of(Index triangle) const;
};

/// Per triangle of a polygon, bit k says whether its edge from corner k is no side of the polygon.
std::vector<std::uint8_t> diagonals_of(const LoadedSurface& surface);

/// Reads surfaces that have passed read_surface_headers, and unwraps them together. `hard_angle` in
/// degrees. Throws Error INVALID_ARGUMENT, OUT_OF_MEMORY or a mesh status, or Cancelled.
Unwrapped unwrap_surfaces(const std::vector<beltrami_surface>& headers, const AtlasOptions& options,
                          bool islands, double hard_angle, const Work& work);

}  // namespace beltrami
