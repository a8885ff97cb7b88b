// A map that lies on itself -> the seams along which to part it.
//
// Pairs of sheets that lie on each other are told apart by least cuts of the dual graph, the
// largest first, until no part lies on itself; then parts that can be one again are. (Which set of
// edges is the cheapest that does so is a multicut problem, and NP-hard.)
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

struct OverlapSplit {
  EdgeMarks seams;        ///< per half-edge of the disk, the two of an edge alike
  double cost = 0;        ///< of the seams, each edge once
  Index parts = 1;        ///< disks that they leave
  Index overlapping = 0;  ///< of these, those that still lie on themselves: see below
};

/// Seams that cut the disk into disks, each of which lies on itself on no more than `tolerance` of
/// its area in the plane, judged by pixels; with a tolerance of 0 not at all, judged exactly. None
/// where the whole map does not. `cost` per half-edge, the two of an edge alike, at least 0;
/// infinite where no seam may be. Parts stay overlapping only where locked edges leave no way, or
/// where there would be hundreds. Precondition: every face is positive in `uvs`, one per vertex.
OverlapSplit split_overlaps(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                            const std::vector<double>& cost, double tolerance, const Work& work);

}  // namespace beltrami
