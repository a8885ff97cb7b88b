// Starts that are isometric where the surface is flat, or nearly, or a strip. Tutte's embedding of
// a thin strip is so far from it that descent does not get there in floating point.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// The vertices seen along the sum of the face normals. Faces that look away are flipped.
std::vector<Vec2> projection(const DiskMesh& mesh);

/// Every face laid out in its rest shape beside the one that it was reached from, from face to face
/// over the longest edge left: isometric where the mesh has no inner vertex, or is flat; elsewhere
/// faces do not fit together, and may be flipped. The boundary may cross itself.
std::vector<Vec2> unfolding(const DiskMesh& mesh, const std::vector<RestTriangle>& rest);

/// The same; or nothing, where a face is flipped, which is mostly found early.
std::vector<Vec2> unflipped_unfolding(const DiskMesh& mesh, const std::vector<RestTriangle>& rest);

}  // namespace beltrami
