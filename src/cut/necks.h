// Cuts of a disk in two across narrow places of its map, for the sake of the room that the parts
// take less than the whole.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// A path from border to border, through vertices inside.
struct Neck {
  std::vector<Index> halfedges;  ///< of the disk, one after the other
  double cost = 0;               ///< of these
  double saved = 0;              ///< room of the map less that of its two parts: see NeckOptions
};

/// The room of a map is the area of its hull, and by how much the square around it is larger than
/// a page.
struct NeckOptions {
  double worth = 1;          ///< what may be paid for a unit of area of room that is saved, > 0
  double page = 0;           ///< area of a page, in the unit of the map
  double least_share = 0.1;  ///< of the area of the map, in each part
  int most = 3;              ///< necks to return
};

/// The places where most is saved for the cost, the best first, each away from those before it:
/// chords between points of the border that lie inside the map, by hulls with sides in a few
/// directions; then the cheapest path near each, if one pays. `uvs`: one per vertex. `cost`: per
/// half-edge, the two of an edge alike, at least 0; infinite where no cut may be. Real faces come
/// first; what fills holes beside them counts as free to cut, and `cost` is to say so. Time: linear
/// but for the paths, each of which looks at what is near its chord. Precondition: an injective
/// map, for its border tells what lies inside.
std::vector<Neck> find_necks(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                             const std::vector<double>& cost, Index real_faces,
                             const NeckOptions& options);

}  // namespace beltrami
