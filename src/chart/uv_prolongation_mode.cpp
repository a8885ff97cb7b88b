// The baseline that carries UVs over instead of coefficients.
#include "base/types.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/fine_problem.h"
#include "chart/modes.h"
#include "chart/options.h"
#include "exact/certificate.h"
#include "flatten/uv_prolongation.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

ChartMap uv_prolongation_mode(const DiskMesh& mesh, Index coarse_faces, const ChartOptions& options,
                              const Work& work) {
  FineProblem fine{.mesh = &mesh};
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
