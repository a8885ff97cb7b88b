// Tutte's embedding as a method of its own, and as what is left where no other map is injective.
#include "base/vectors.h"
#include "base/work.h"
#include "baselines/baselines.h"
#include "descend/tutte.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "multilevel/chart_map.h"
#include "multilevel/extras.h"
#include "multilevel/memory.h"
#include "multilevel/options.h"
#include "repair/repair.h"

namespace beltrami {

double tutte_bytes(const MeshCounts& n, int threads) {
  return 3 * n.vertices * sizeof(Vec2) + system_bytes(n, 1, Precision::kDouble, threads).peak;
}

ChartMap tutte_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work) {
  ChartMap map;
  run_stage("tutte", work, map.statistics.stages, [&](StageStatistics&, const Work& inner) {
    map.uvs = tutte_embedding(mesh, inner);
    const auto rest = rest_triangles(mesh.positions, mesh.faces, inner);
    const RepairOptions how{.simple_boundary = true,
                            .global_fix = affords(mesh, options, Extra::kGlobalFix, inner)};
    const RepairResult repaired = repair(mesh, rest, map.uvs, how, inner);
    map.statistics.flips_before_repair = repaired.flips_before;
  });
  return map;
}

}  // namespace beltrami
