// Tutte's embedding (Tutte 1963; Floater 1997): the injective start of the full-space optimisation.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// The boundary loop on a circle around the origin by arc length, its disk of the area of the mesh,
/// every interior vertex at the mean of its neighbours: injective in exact arithmetic. Uniform
/// weights, since cotangents can be negative and then flip. Returns one UV per vertex.
/// Throws Error SOLVER if the system cannot be solved.
std::vector<Vec2> tutte_embedding(const DiskMesh& mesh, const Work& work);

/// The global scale at which the mean energy of a map is least; 1 if a face is flipped or
/// degenerate.
double best_scale(Energy energy, const std::vector<Triangle>& faces,
                  const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                  const Work& work);

/// The mean energy of a map; infinite if a face is flipped or degenerate.
double mean_energy(Energy energy, const std::vector<Triangle>& faces,
                   const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                   const Work& work);

}  // namespace beltrami
