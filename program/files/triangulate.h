// Polygons into triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// Three corners for each triangle, those of one polygon after another: n - 2 for n corners, in the
/// orientation of the polygon. A triangle stays as it is.
///
/// A polygon is cut into ears (Meisters 1975) in the plane of Newell's normal, the best-shaped ear
/// first, so that a planar simple polygon, convex or not, is covered once. A cut is never an edge
/// that the mesh has already: the triangles form the surface that the polygons formed, a disk if
/// that was one. Where the two wishes conflict, or a polygon is not planar and simple, the latter
/// wins. The result depends on positions and polygons alone.
///
/// Throws Failure for a polygon that names a vertex twice (REPEATED_VERTEX), or that every way of
/// cutting would repeat an edge in.
std::vector<std::uint32_t> triangulate(const MeshFile& mesh);

/// The same as corners of the file's faces, and whatever they name.
std::vector<std::uint32_t> triangle_corners(const MeshFile& mesh);

}  // namespace beltrami::cli
