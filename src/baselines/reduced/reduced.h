// The paper's own flattening of the fine mesh: a map from the reduced harmonic subspace of a few
// boundary vertices, of least energy on sampled faces (paper section 3.5).
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "flatten/laplacian.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Meta vertices that dense algebra can serve: beyond, a Newton step takes several seconds.
inline constexpr Index kMostMetas = 1000;

struct ReducedOptions {
  Energy energy = Energy::kSymmetricDirichlet;
  bool scaffold = true;     ///< GIF: the boundary may not cross itself. false: FLIM, no flips alone
  double tolerance = 1e-3;  ///< relative energy decrease of a step of at least 1/2 that ends it
  int max_iterations = 200;  ///< Newton steps
};

struct ReducedResult {
  std::vector<Vec2> uvs;  ///< one per vertex; faces may be flipped: see repair
  std::vector<double>
      energies;  ///< mean over the samples, at first and after each step; never rising
  int meta_vertices = 0;
  int samples = 0;
  bool converged = false;
  bool simple_boundary = false;  ///< of `uvs`, exactly
};

/// Flattens a disk. Boundary vertices lie on straight pieces between meta vertices, the interior is
/// harmonic in the metric of the corner `cotangents` (those of the surface: plain GIF or FLIM).
/// Starts from the meta vertices on a circle; ends, not converged, where the time is up. The same
/// bits at any number of threads. Throws Error SOLVER where a system cannot be solved, or where
/// bridges call for more meta vertices than dense algebra can serve.
ReducedResult flatten_reduced(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                              const std::vector<Cotangents>& cotangents,
                              const ReducedOptions& options, const Work& work);

}  // namespace beltrami
