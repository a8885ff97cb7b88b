// Straight borders along the axes, and on the edges of texels.
#pragma once

#include <optional>
#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Turns every map so that the most of its border that is straight in two directions at right
/// angles lies along the axes, and has it `aligned`: but for maps of which no share worth the name
/// does.
void align_to_borders(const std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps);

/// The turn (cosine, sine) by which it does so with one map; none that is worth it.
std::optional<Vec2> turn_to_borders(const DiskMesh& mesh, const std::vector<Vec2>& uvs);

/// Moves the borders of a map that lie along an axis for a texel or more onto the nearest texel
/// edges, and what is between them in proportion: nothing by more than half a texel. Where that
/// would fold a face, the map as a whole is moved, so that the longest of them lies on one.
/// `placed`: per vertex, in the plane of pages of so many texels to the side.
void snap_to_texels(const DiskMesh& mesh, int resolution, std::vector<Vec2>& placed,
                    const Work& work);

}  // namespace beltrami
