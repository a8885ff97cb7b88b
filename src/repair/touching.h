// Boundaries that touch themselves. In the isometric map of a flat piece with a hole the two sides
// of a slit lie on each other: they part by moving a little into the piece.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// The map with the vertices at which the closed polygon uvs[loop[0]], uvs[loop[1]], ... meets
/// itself moved inwards (to its left) by about `distance`, at `snap` of the place each; nothing
/// where the polygon is not simple then.
std::optional<std::vector<Vec2>> with_sides_apart(const std::vector<Index>& loop,
                                                  const std::vector<Vec2>& uvs, double distance,
                                                  const std::function<Vec2(const Vec2&)>& snap);

/// Parts what touches in a map of positive faces, by the least of some distances, all of them small
/// beside the map, that make its boundary simple and fold no face. Whether one did; else `uvs` is
/// left as it is.
bool open_touching_sides(const DiskMesh& mesh, const Work& work, std::vector<Vec2>& uvs);

}  // namespace beltrami
