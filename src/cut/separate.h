// The cheapest cut of a disk between two sheets of its map.
#pragma once

#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/part.h"
#include "cut/sheets.h"

namespace beltrami {

/// A cut into disks.
struct Separation {
  EdgeMarks marks;  ///< per half-edge; none: there is no cut
  double cost = 0;  ///< of the edges
  bool none() const { return marks.empty(); }
};

/// Edges that part the sheets, and join every closed curve of those to the boundary, so that disks
/// are left. A least cut of the dual graph, whose edges cost more near the sheets: it would hug
/// them. Sheets of less than a hundredth of the area grow to that where there is room between
/// them, so that no slivers come off. None where locked edges leave no way. Large parts are cut by
/// patches of faces first, then face by face nearby.
Separation separate(const Part& part, const Sheets& sheets, const Work& work);

}  // namespace beltrami
