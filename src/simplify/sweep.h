// Half-edge collapses in the order of the vertices, for the first levels of a large surface.
#pragma once

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Collapses vertices off the boundary until about `target_faces` faces are left, or few more would
/// go; it may end somewhat below. The topology stays, and the whole boundary does. Cheaper than
/// passes (simplify_surface) and not as choosy: for what a coarser level follows on. Neighbours
/// should lie close in memory (mesh/locality.h). Precondition: every vertex is used by a face. The
/// same bits at any number of threads.
CoarseSurface sweep_surface(const Surface& fine, Index target_faces, const Work& work);

/// The same of a disk.
CoarseDisk sweep_disk(const DiskMesh& fine, Index target_faces, const Work& work);

}  // namespace beltrami
