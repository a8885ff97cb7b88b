// What an artist asks of the borders of charts: rectangles, grids of quads, straight edges.
#pragma once

#include "admit/admit.h"
#include "atlas/open_and_map.h"
#include "atlas/types.h"
#include "base/work.h"

namespace beltrami {

/// Whether anything is asked.
bool asks_for_straight(const AtlasInput& input, const AtlasOptions& options);

/// Maps the charts anew of which straight borders are asked, or that are grids of quads where these
/// are; they are injective, and `aligned` from then on. Throws Error PINS with the face of a
/// rectangle, or a vertex of the straight edges, where no such map was found, INVALID_ARGUMENT with
/// the vertex where edges branch, form a loop or are none of the surface, and where a chart of
/// theirs has pins.
void straighten_charts(const AtlasInput& input, const Admitted& admitted,
                       const AtlasOptions& options, const Work& work, MappedSurface& mapped);

}  // namespace beltrami
