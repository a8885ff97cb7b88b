// Holes, closed with virtual faces: a disk with holes stays one chart, and what closes them costs
// no seam and is taken away at the end.
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "mesh/surface.h"

namespace beltrami {

/// A surface whose last vertices and faces are virtual.
struct FilledSurface {
  Surface surface;
  Index real_vertices = 0, real_faces = 0;
  Index filled_loops = 0;
};

/// Fills each boundary loop no longer than `limit` times the root of its component's area: one of
/// three edges with a face, others with a fan around their centre. Left open are the longest loop
/// of each component, for that is its outline, and loops that span no area. The only loop of a
/// component with handles is filled where it is an opening, short for the component's area. Time:
/// linear. Preconditions: `topology` is the surface's; lengths far from the ends of the range of
/// numbers.
FilledSurface fill_holes(Surface surface, const Topology& topology, double limit, const Work& work);

}  // namespace beltrami
