// The fine map's equations from a carried derivative, in one pass over the faces: what each face is
// to become, how stiff it is there, and how far from it the present map is.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "linear/smoother.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/derivative.h"

namespace beltrami {

struct TargetEquations {
  std::vector<SingleWeights> weights;  ///< per face: of the energy at the carried derivative
  SingleField residual;                ///< per vertex: what pulls `uvs` to it, as in solve_metric
};

/// Of the map `uvs` and the `derivatives` at the vertices, see derivative_of_face. A face without a
/// normal keeps the shape that it has.
TargetEquations target_equations(Energy energy, const DiskMesh& mesh,
                                 const std::vector<RestTriangle>& rest,
                                 const std::vector<VertexDerivative>& derivatives,
                                 const std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
