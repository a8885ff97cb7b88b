// Fine disk -> coarse disk, and any surface -> a coarse one, by quadric edge collapse (Garland &
// Heckbert 1997; paper section 3.1).
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Collapses half-edges until at most `target_faces` faces are left or no collapse is
/// allowed; with `target_faces` >= the face count it returns the mesh itself. The result is a disk
/// (proved by build_disk). Kept whatever the target: at least 8 boundary vertices (or all), the
/// tips of ears, both ends of every bridge and one boundary vertex between successive bridge ends,
/// since what lies on one coarse boundary edge becomes collinear in the plane. Deterministic.
CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Work& work);

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
