// The boundary loop as a polygon.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Length of the boundary edge that starts at each position of the loop, all > 0: an edge of no
/// length gets a thousandth of the mean one, so that no two vertices of a layout by arc length
/// coincide.
std::vector<double> boundary_lengths(const DiskMesh& mesh);

/// Places on a circle of the area of the mesh, by arc length; one per position of the loop.
std::vector<Vec2> boundary_on_circle(const DiskMesh& mesh, const Work& work);

/// The UVs along the boundary loop.
std::vector<Vec2> boundary_polygon(const DiskMesh& mesh, const std::vector<Vec2>& uvs);

/// Per vertex, whether it is the first of the boundary loop: what is held where a map is free to
/// move as a whole.
std::vector<bool> only_first_of_boundary(const DiskMesh& mesh);

}  // namespace beltrami
