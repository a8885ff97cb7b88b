// From the caller's polygons to what the atlas takes, and back to the caller's corners.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "admit/triangulate.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// Polygons, cut into triangles.
struct LoadedSurface {
  Index vertex_count = 0;
  std::vector<Vec3> positions;  ///< of vertices that no face names, zero if not finite
  Polygons polygons;
  Triangulation triangulation;
  std::vector<Index> face_of_triangle;  ///< empty where all faces are triangles

  Index face_of(Index triangle) const {
    return face_of_triangle.empty() ? triangle : face_of_triangle[triangle];
  }
};

/// Copies the counts with the caller's sizes checked. Throws Error INVALID_ARGUMENT or EMPTY.
beltrami_surface read_surface_header(const beltrami_surface* theirs);

/// Reads positions and faces. Throws Error INVALID_ARGUMENT, INDEX_OUT_OF_RANGE with the face, or
/// NON_FINITE with the vertex. `header` has passed read_surface_header.
LoadedSurface read_surface(const beltrami_surface& header, const Work& work);

/// The same, where positions may be missing if all faces are triangles: they are zero then.
LoadedSurface read_surface_to_check(const beltrami_surface& header, const Work& work);

/// The same, where they need not be finite.
LoadedSurface read_surface_to_triangulate(const beltrami_surface& header, const Work& work);

/// Three vertices per triangle.
std::vector<Triangle> triangles_of(const LoadedSurface& surface);

/// The corner UVs, one per corner. Throws Error INVALID_ARGUMENT, or NON_FINITE with the face.
std::vector<Vec2> read_corner_uvs(const beltrami_surface& header, const LoadedSurface& surface,
                                  const Work& work);

/// Numbers labels by their order.
std::vector<Index> dense(const std::vector<std::uint64_t>& labels);

/// What comes with the surface, per triangle. `islands`: corner UVs count. Throws Error
/// INVALID_ARGUMENT, INDEX_OUT_OF_RANGE for an end of a seam, or NON_FINITE with the face.
AtlasInput atlas_input(const beltrami_surface& header, const LoadedSurface& surface, bool islands,
                       const Work& work);

}  // namespace beltrami
