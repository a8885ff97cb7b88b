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
  std::vector<AtlasChart> charts;  ///< of the ground, in its unit, by their least face
  std::vector<Index> opened;       ///< half-edges of the ground beyond the seams that were cut
};

/// Cuts `faces`, increasing, along the seams between them; their border is cut anyway. Seams that
/// meet no border and enclose nothing wait until they do, unless there is nothing else to open a
/// closed surface by. Holes are filled as ever; what is no disk then is cut along a short graph: the
/// edges `opened` before where they still serve. Throws what the stages do.
Recut recut(const Ground& ground, const std::vector<Index>& faces, const EdgeMarks& seams,
            const EdgeMarks& opened, const Work& work);

}  // namespace beltrami
