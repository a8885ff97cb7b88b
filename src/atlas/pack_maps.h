// The maps of an atlas -> pages of a texture, in the numbers that are delivered.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/pages.h"
#include "base/vectors.h"
#include "base/work.h"
#include "pack/outline.h"
#include "pack/types.h"

namespace beltrami {

/// The real faces of a map, on the vertices that they use.
PackChart real_part(const AtlasChart& chart, const std::vector<Vec2>& uvs);

/// Its outline, sooner: edges between two faces of one orientation are no part of it.
Outline outline_of(const AtlasChart& chart, const std::vector<Vec2>& uvs);

/// Moves every map by a rigid motion of its own and scales all of them alike, onto pages (tile_of)
/// in the numbers delivered; with `snap` as snap_to_texels has it from there. What rounding would
/// fold is mended, and outcomes say where it cannot be; the margin asked for holds then, too.
/// Stored in single precision, with the V axis up or down, the maps stay injective. On further
/// pages than the first one numbers are multiples of step_of where that can be: taken without the
/// page's corner they round to themselves. Virtual faces may lie beneath other charts; maps that
/// failed get one point on the first page. Options: texels per unit of the maps. Throws Error
/// NO_ROOM where they do not fit. Precondition: no pins. Fills all of the result but utilisations.
Pages pack_maps(const std::vector<AtlasChart>& charts, const PackOptions& options, bool float32,
                std::vector<MappedChart>& maps, const Work& work);

}  // namespace beltrami
