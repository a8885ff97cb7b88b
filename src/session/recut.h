// Some faces of the ground and the seams that are asked for -> disks.
#pragma once

#include <vector>

#include "atlas/open.h"
#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "session/ground.h"

namespace beltrami {

struct Recut {
  std::vector<AtlasChart> charts;  ///< of the ground, in its unit, by their least face of
                                   ///< the input
  std::vector<Index> opened;       ///< half-edges of the ground beyond the seams that were cut
};

/// Cuts `faces`, increasing, along the seams between them and the edges that were `opened` before;
/// their border is cut anyway. Seams that meet neither the border nor what was opened, and enclose
/// nothing, wait until they do, unless there is nothing else to open a closed surface by: then
/// those that are `standing`, cut so far, serve, or else the longest. Holes are filled as ever;
/// what is no disk then is cut along a short graph. Throws what the stages do.
Recut recut(const Ground& ground, const std::vector<Index>& faces, const EdgeMarks& seams,
            const EdgeMarks& opened, const EdgeMarks& standing, const Work& work);

}  // namespace beltrami
