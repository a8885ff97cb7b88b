// Collapses done again on a surface that has been cut since: its charts inherit what was done to
// it, away from their seams.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "simplify/coarse.h"
#include "simplify/history.h"

namespace beltrami {

/// Which collapses of a surface can be done again, in their order, where the vertices `kept` stay:
/// all but those that look at something which is not as it was then, a vertex that is kept or the
/// faces around one that a collapse left out would have changed. So what is left out spreads by
/// about a ring from pass to pass, and what is left of the surface grows coarser away from what is
/// kept (as splits ask for their neighbours in Hoppe 1997, "View-Dependent Refinement of
/// Progressive Meshes"). Returns per fine vertex the step that takes it away, or kNone. Only
/// vertices that are not kept go, and onto such: cut along edges between kept vertices, the surface
/// keeps its topology and its boundary. The first of these collapses, however many, are as good.
/// Time: linear.
std::vector<Index> repeatable_steps(const CollapseHistory& history, const std::vector<bool>& kept);

/// The disk that collapses leave of a fine one. `into`: per fine vertex the next one on its way, or
/// itself. Throws Error INTERNAL if it is no disk.
CoarseDisk collapsed_disk(const DiskMesh& fine, std::vector<Index> into, const Work& work);

/// What `simplify` makes of a level of the disk, between it and the coarse one.
CoarseDisk simplify_further(const CoarseDisk& level, Index target_faces, const Work& work);

}  // namespace beltrami
