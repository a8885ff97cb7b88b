// Which boundary vertices of a fine map are drawn to where the coarse map has them, so that parts
// of the boundary that press on each other there do not cross here.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Per fine vertex: whether it is one of the coarse boundary that is near other parts of it in the
/// map `coarse_uvs`. Those between them are at liberty: carried over they are on straight lines,
/// which on the surface they need not be.
std::vector<bool> vertices_in_contact(const CoarseDisk& coarse, const std::vector<Vec2>& coarse_uvs,
                                      Index fine_vertices);

/// Calls `solve`, which writes a map with the vertices `anchored` (per vertex, or empty) into `uvs`
/// and returns whether it is worth going on, until the boundary of that map is simple: each time
/// with all vertices anchored as well that are near a crossing, further around in each round.
/// Returns whether the boundary ends simple; false also where `solve` does not want to go on.
bool solve_until_simple(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                        std::vector<bool>& anchored, const std::function<bool()>& solve);

/// Springs leave the vertices `anchored` (per vertex, or empty) a little beside their `carried`
/// places, which is enough for narrow gaps to close: puts them there.
void put_in_place(const std::vector<bool>& anchored, const std::vector<Vec2>& carried,
                  std::vector<Vec2>& uvs);

}  // namespace beltrami
