// A surface and the marked edges that part it -> its charts.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/chart.h"
#include "mesh/surface.h"

namespace beltrami {

/// A piece of a surface that is no disk.
struct NonDisk {
  std::vector<Index> faces;  ///< of the surface, increasing
  Index loops = 0;           ///< of its boundary; none: it is closed
  Index genus = 0;           ///< its handles
};

/// Charts and other pieces, each by their least face.
struct CutSurface {
  std::vector<Chart> charts;  ///< of vertices and faces of the surface
  std::vector<NonDisk> non_disks;
  std::vector<Index> chart_of_face;  ///< kNone in a piece that is no disk
};

/// Pieces are faces connected over unmarked edges; their vertices are corners united over these.
/// A marked edge that joins neither another one nor the boundary at either end parts nothing.
CutSurface cut_into_charts(const Surface& surface, const EdgeMarks& marks, const Work& work);

}  // namespace beltrami
