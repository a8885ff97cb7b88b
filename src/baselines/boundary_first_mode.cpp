// Boundary first flattening in the prolonged metric, or in that of the surface.
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "baselines/baselines.h"
#include "baselines/boundary_first.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/options.h"

namespace beltrami {

double boundary_first_bytes(const MeshCounts& n, int threads) {
  // Columns of curvatures and of factors, the places, and products of the Laplacian with them.
  return fine_bytes(n) + 5 * n.vertices * sizeof(Vec2) +
         system_bytes(n, 1, Precision::kSingle, threads).peak;
}

ChartMap boundary_first_mode(const MapProblem& fine, const ChartOptions& options,
                             const Work& work) {
  const DiskMesh& mesh = *fine.mesh;
  ChartMap map;
  run_stage("flatten", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    const auto lengths = metric_boundary_lengths(mesh, fine.rest, fine.metric);
    map.uvs = flatten_boundary_first(mesh, fine.rest, fine.metric, lengths, inner).uvs;
    // A conformal map is as good at any scale; the energies are not.
    const double scale = best_scale(options.energy, mesh.faces, fine.rest, map.uvs, inner);
    for (Vec2& w : map.uvs) w *= scale;
  });
  map.statistics.flips_before_repair = size_of(non_positive_faces(mesh.faces, map.uvs, work));
  return map;
}

}  // namespace beltrami
