// The simplifiers behind simplify(), and what they share.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Both keep the contract of simplify(), whichever of them it calls.
/// In passes over flat arrays, on several threads; always compiled.
CoarseDisk simplify_in_passes(const DiskMesh& fine, Index target_faces, const Work& work);
/// By OpenMesh's decimater, one collapse after the other; compiled where OpenMesh is at hand.
CoarseDisk simplify_by_openmesh(const DiskMesh& fine, Index target_faces, const Work& work);

/// The mesh itself: nothing collapsed.
CoarseDisk whole_disk(const DiskMesh& fine);

/// The disk that collapses left: of `fine_vertex` (per coarse vertex, increasing) and `faces` (of
/// coarse vertices). `collapsed_into`: per fine vertex the next one on the way, or itself.
/// Throws Error INTERNAL if it is not a disk.
CoarseDisk coarse_disk(const DiskMesh& fine, std::vector<Index> fine_vertex,
                       std::vector<Triangle> faces, std::vector<Index> collapsed_into,
                       const Work& work);

/// The same where the adjacency of what is left is known.
CoarseDisk coarse_disk(Surface left, std::vector<Index> fine_vertex,
                       std::vector<Index> collapsed_into, const Work& work);

}  // namespace beltrami
