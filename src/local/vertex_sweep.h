// Newton's method vertex by vertex, for what no system of many vertices can be solved with.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Moves these vertices one after the other, each by a step of Newton's method with a line search
/// for the energy of the faces at it: nonlinear Gauss-Seidel (Brandt 1977, "Multi-level adaptive
/// solutions to boundary-value problems"; Hackbusch 1985, chapter 9). The systems have two
/// unknowns: what is worse than any larger one can be solved with, faces of an energy of 1e26, is
/// gone after one or two sweeps. The energy never rises and positive faces stay so. Vertices on the
/// boundary, at faces that are not positive and of more than a thousand faces stay where they are.
/// `rest`: one entry per face, `uvs`: one per vertex. Throws nothing of its own.
void sweep_vertices(Energy energy, const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, const std::vector<Index>& vertices);

}  // namespace beltrami
