#include "chart/refine.h"

#include <utility>

#include "base/types.h"
#include "base/vectors.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "mesh/rest_shape.h"
#include "multilevel/descent.h"

namespace beltrami {

void refine(const DiskMesh& mesh, const ChartOptions& options, const Work& work, ChartMap& map) {
  const bool simple = keeps_boundary_simple(options);
  const Certificate certificate = certify(mesh.faces, mesh.boundary, map.uvs, work);
  if (certificate.orientations.first_bad_face != kNone) return;
  if (simple && certificate.crossings.count > 0) return;
  run_stage("refine", work, map.statistics.stages, [&](StageStatistics& stage, const Work& inner) {
    const auto rest = rest_triangles(mesh.positions, mesh.faces, inner);
    const auto scaled_energy = [&](std::vector<Vec2>& uvs) {
      scale_best(mesh, rest, options, inner, uvs);
      return mean_energy(options.energy, mesh.faces, rest, uvs, inner);
    };
    const double before = scaled_energy(map.uvs);
    NewtonOptions newton = newton_options(options);
    newton.proxy_steps = 0;  // they pay far from the minimum
    if (options.refine_iterations > 0) newton.max_iterations = options.refine_iterations;
    Descent done = descend(mesh, rest, map.uvs, newton, simple, options, inner);
    stage.iterations = done.iterations;
    // The barrier of the contact may have fallen instead.
    if (scaled_energy(done.uvs) <= before) map.uvs = std::move(done.uvs);
    const bool as_asked = options.refine_iterations > 0 && !inner.out_of_time();
    if (!done.converged && !as_asked) map.converged = false;
  });
}

}  // namespace beltrami
