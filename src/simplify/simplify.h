// Fine disk -> coarse disk, and any surface -> a coarse one, by quadric edge collapse (Garland &
// Heckbert 1997; paper section 3.1).
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/history.h"

namespace beltrami {

/// A coarse disk whose vertices are a subset of the fine ones, the boundary loop in the same order.
struct CoarseDisk {
  DiskMesh mesh;
  std::vector<Index> fine_vertex;  ///< per coarse vertex: the fine vertex that it is
  std::vector<Index> nearby;  ///< per fine vertex: the coarse vertex that it was collapsed into
};

/// Collapses half-edges until at most `target_faces` faces are left or no collapse is
/// allowed; with `target_faces` >= the face count it returns the mesh itself. The result is a disk
/// (proved by build_disk). Kept whatever the target: at least 8 boundary vertices (or all), the
/// tips of ears, both ends of every bridge and one boundary vertex between successive bridge ends,
/// since what lies on one coarse boundary edge becomes collinear in the plane. Deterministic.
CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Work& work);

/// A coarse surface whose vertices are a subset of the fine ones, and the way back.
struct CoarseSurface {
  Surface mesh;
  std::vector<Index> fine_vertex;  ///< per coarse vertex: the fine vertex that it is
  std::vector<Index> fine_face;    ///< per coarse face: the fine face that it was, increasing
  CollapseHistory history;
};

/// The same on any surface, in our sweeps (sweep.h) as long as it is large, and then our passes:
/// components, handles and boundary loops stay, each loop with at least 8 vertices (or all).
/// `loops` are the surface's. Precondition: every vertex is used
/// by a face.
CoarseSurface simplify_surface(const Surface& fine, const BoundaryLoops& loops, Index target_faces,
                               const Work& work);

/// "native" or "openmesh": the back end is chosen when the library is built
/// (-DBELTRAMI_SIMPLIFIER=native|openmesh).
const char* simplifier_name();

}  // namespace beltrami
