// The baseline that carries UVs over instead of coefficients.
#include "base/types.h"
#include "base/work.h"
#include "baselines/baselines.h"
#include "baselines/uv_prolongation.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/options.h"

namespace beltrami {

ChartMap uv_prolongation_mode(const DiskMesh& mesh, Index coarse_faces, const ChartOptions& options,
                              const Work& work) {
  MapProblem fine{.mesh = &mesh};
  simplify_fine(coarse_faces, {}, work.part(0, 0.13), fine);
  solve_coarse(options, work.part(0.13, 0.25), fine);
  ChartMap map;
  run_stage("prolong", work.part(0.25, 1), map.statistics.stages,
            [&](StageStatistics&, const Work& inner) {
              map.uvs = prolong_uvs(fine.coarse.mesh, fine.coarse_uvs, mesh, inner);
            });
  map.statistics.flips_before_repair = size_of(non_positive_faces(mesh.faces, map.uvs, work));
  return joined(std::move(fine), std::move(map));
}

}  // namespace beltrami
