// Parts that need not be apart -> fewer, and shorter seams between the others.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/layers.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// A disk with a map, and the seams that part it.
struct PartedMap {
  const DiskMesh& disk;
  const std::vector<Vec2>& uvs;
  const std::vector<double>& cost;  ///< per half-edge; infinite where locked
  const Layers& layers;
  double tolerance;                 ///< see split_overlaps.h
  std::vector<Index> part_of_face;  ///< in [0, parts)
  Index parts;
  EdgeMarks seams;
};

/// Takes two parts for one where that is a disk and does not lie on itself, those with the dearest
/// seams first, and looks for cheaper seams between two that must be apart. Numbers parts anew, by
/// their first faces.
void merge_parts(PartedMap& map, const Work& work);

}  // namespace beltrami
