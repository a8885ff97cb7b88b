// Polygons that stay in one piece, whatever they are.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "mesh/surface.h"

namespace beltrami {

/// Whether an edge of the surface, by its half-edges, lies inside a polygon: not where a side of it
/// meets another side of the same. Precondition: polygons are given.
bool is_inside_polygon(const Admitted& admitted, const PolygonParts& polygons, Index h, Index twin);

/// Marks per face of the input, in `apart`, the polygons whose faces on the surface form several
/// pieces. Returns whether there are any that had no mark.
bool mark_torn(const Admitted& admitted, const PolygonParts& polygons, std::vector<bool>& apart);

/// Gives polygons that are marked, and of which a face has no area in space, the places of a
/// regular polygon with their area: any triangulation covers that once. `without`: the faces of the
/// input without area. Others, and what is no disk, keep their places.
void regularize(const Admitted& admitted, const PolygonParts& polygons,
                const std::vector<bool>& apart, const std::vector<bool>& without, Surface& surface);

}  // namespace beltrami
