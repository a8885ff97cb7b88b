// Seams of half a surface, for all of it.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/mirror.h"
#include "cut/seam_surface.h"
#include "mesh/surface.h"

namespace beltrami {

/// The seams on one side of the mirror and in it, and, edges for edges, those that they are
/// mirrored to on the other. `side`: 1 where the mirror's normal points, or -1. Seams that come to
/// leave a piece narrower than edges are long are joined on one of its sides; of what is no disk
/// then, a ring is opened where that is cheapest, near the mirror for preference, and the rest
/// along a short cut graph. `cost`: per half-edge, infinite where no seam may be. Locked edges are
/// not cut to open it, where there is a way.
AnchoredSeams mirrored_seams(const Surface& surface, const Mirror& mirror,
                             const AnchoredSeams& seams, int side, const std::vector<double>& cost,
                             const EdgeMarks& locked, const Work& work);

/// What a vertex is mirrored to: itself in the mirror's plane, and where no image is known.
inline Index mirrored(const Mirror& mirror, Index vertex) {
  const Index image = mirror.image[vertex];
  return mirror.side[vertex] == 0 || image == kNone ? vertex : image;
}

}  // namespace beltrami
