// Two parts of a map that lie on each other.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "cut/layers.h"
#include "cut/max_flow.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {

/// Two sheets of a map, one on the other: the faces of one are sources, those of the other sinks.
struct Sheets {
  std::vector<Terminal> terminals;  ///< per face
  bool is_band = false;  ///< parts of sheets that go on to lie on themselves, as spirals do
  bool none() const { return terminals.empty(); }
};

/// The `rank`-th largest of the pairs of sheets, from 0 on; none beyond the last. Where a sheet
/// goes on to be the other one, it is a part of both at one end, so that there is room for a cut.
/// Of pixels in many faces only the first few are looked at.
Sheets largest_sheets(const Surface& mesh, const std::vector<Vec2>& uvs, const Layers& layers,
                      Index rank);

/// Faces of two boundary edges that meet, for overlaps finer than pixels; none where no two do.
Sheets crossing_faces(const DiskMesh& mesh, const std::vector<Vec2>& uvs);

}  // namespace beltrami
