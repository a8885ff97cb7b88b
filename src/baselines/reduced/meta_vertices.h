// The degrees of freedom of the reduced flattening: a few boundary vertices that the rest of the
// boundary follows (paper section 3.5; Fargion & Weber 2022).
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// The boundary as a polygon of meta vertices. A boundary vertex between two of them lies on the
/// straight piece that joins them, by arc length in space.
struct MetaVertices {
  std::vector<Index> loop;  ///< positions in mesh.boundary, ascending; at least 3
  /// Per position in mesh.boundary: the meta (as an index into `loop`) at or before it, and the
  /// share of the way to the next meta, in [0, 1); 0 at the metas themselves.
  std::vector<Index> piece;
  std::vector<double> share;
  std::vector<double> arc;  ///< per meta: length of the piece that starts at it, > 0

  Index count() const { return size_of(loop); }
  Index next(Index meta) const { return meta + 1 == count() ? 0 : meta + 1; }
};

/// Chooses them: every s-th boundary vertex, s = 10 or less; the 0.1% of greatest |Gaussian
/// curvature|; both ends of every bridge (interior edge that joins two boundary vertices) and one
/// vertex between bridge ends that follow each other, without which the faces cut off by the bridge
/// would be collinear. About 250 at most, bridge ends on top.
MetaVertices choose_meta_vertices(const DiskMesh& mesh, const Work& work);

}  // namespace beltrami
