// GIF and FLIM: the harmonic subspace of a few boundary vertices (paper section 3.5).
#include <algorithm>
#include <utility>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "baselines/baselines.h"
#include "baselines/reduced/meta_vertices.h"
#include "baselines/reduced/reduced.h"
#include "descend/grid_drawing.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "flatten/laplacian.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/descent.h"
#include "multilevel/extras.h"
#include "multilevel/flat_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/options.h"
#include "repair/repair.h"

namespace beltrami {
namespace {

/// Samples besides the metas' own, each with rows of three vertices and two edges; of the Newton
/// systems, which are dense, the matrix and its factor. Measured.
constexpr double kSamples = 2000, kRowsOfSample = 5, kNewtonCopies = 2;

/// Composite majorization of the fine mesh, from its boundary on a circle; with `simple` the
/// boundary stays so.
Descent descend_from_circle(const MapProblem& fine, bool simple, const ChartOptions& options,
                            const Work& work) {
  const DiskMesh& mesh = *fine.mesh;
  std::vector<Vec2> uvs = tutte_embedding(mesh, work);
  const RepairOptions how{.simple_boundary = true,
                          .global_fix = affords(mesh, options, Extra::kGlobalFix, work)};
  repair(mesh, fine.rest, uvs, how, work);
  if (!certify(mesh.faces, mesh.boundary, uvs, work).injective()) {
    uvs = grid_drawing(mesh);
  }
  scale_best(mesh, fine.rest, options, work, uvs);
  start_flat(mesh, fine.rest, options, uvs, work);
  return descend(mesh, fine.rest, std::move(uvs), newton_options(options), simple, options, work);
}

}  // namespace

double count_metas(const DiskMesh& mesh) {
  return std::min(choose_meta_vertices(mesh, Work(1)).count(), kMostMetas);
}

double reduced_bytes(const MeshCounts& n, int threads) {
  // A factor in double precision, then rows of the basis, which is dense.
  const double metas = n.metas;
  const double basis =
      kRowsOfSample * std::min(kSamples + metas, n.faces) * metas * sizeof(double) +
      kNewtonCopies * 4 * metas * metas * sizeof(double);
  const System system = system_bytes(n, 1, Precision::kDouble, threads);
  return fine_bytes(n) + n.faces * sizeof(Cotangents) + n.vertices * sizeof(Vec2) +
         std::max(system.peak, system.kept + basis);
}

/// Without inner vertices nothing is harmonic, and the subspace that of all maps: the same problem,
/// for which sparse steps take a fraction of the time of dense ones.
ChartMap reduced_mode(const MapProblem& fine, bool scaffold, const ChartOptions& options,
                      const Work& work) {
  ChartMap map;
  const auto flatten = [&](StageStatistics& stage, const Work& inner) {
    if (size_of(fine.mesh->boundary) == fine.mesh->vertex_count()) {
      Descent done = descend_from_circle(fine, scaffold, options, inner);
      stage.iterations = done.iterations;
      map.converged = done.converged;
      map.uvs = std::move(done.uvs);
      return;
    }
    ReducedOptions reduced;
    reduced.scaffold = scaffold;
    reduced.energy = options.energy;
    ReducedResult done = flatten_reduced(*fine.mesh, fine.rest, fine.cotangents, reduced, inner);
    stage.iterations = static_cast<int>(done.energies.size()) - 1;
    map.converged = done.converged;
    map.uvs = std::move(done.uvs);
  };
  run_stage("flatten", work.part(0, 0.8), map.statistics.stages, flatten);
  mend(fine, whole_repair(fine, scaffold, options, work), options, work.part(0.8, 1), map);
  return map;
}

}  // namespace beltrami
