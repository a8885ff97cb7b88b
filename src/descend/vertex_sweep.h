// Newton's method vertex by vertex, which takes the roughness out of a map.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Moves the vertices one after the other, each by a step of Newton's method with a line search for
/// the energy of the faces at it: nonlinear Gauss-Seidel, the smoother of multigrid methods for
/// nonlinear problems (Brandt 1977, "Multi-level adaptive solutions to boundary-value problems";
/// Hackbusch 1985, chapter 9). It takes the time of a few evaluations of the energy; what is wrong
/// from one face to the next, which holds up steps of the whole map, is gone after one or two. The
/// energy never rises and positive faces stay so. Vertices on the boundary, at faces that are not
/// positive and of more than a thousand faces stay where they are. `rest`: one entry per face,
/// `uvs`: one per vertex. Throws nothing of its own.
///
/// Vertices go in blocks of neighbours in memory (mesh/locality.h), side by side; after them those
/// with neighbours in other blocks, in sets in which no two are neighbours: the same bits at any
/// number of threads.
void sweep_vertices(Energy energy, const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
