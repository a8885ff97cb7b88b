// The harmonic map in the prolonged Beltrami coefficients (paper section 3.4).
#include "base/vectors.h"
#include "base/work.h"
#include "flatten/dirichlet.h"
#include "flatten/laplacian.h"
#include "linear/spd_solver.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/memory.h"
#include "multilevel/mode_bytes.h"
#include "multilevel/modes.h"
#include "multilevel/options.h"

namespace beltrami {

double harmonic_bytes(const MeshCounts& n, int threads) {
  return n.faces * sizeof(Cotangents) + 2 * n.vertices * sizeof(Vec2) +
         system_bytes(n, 1, Precision::kSingle, threads).peak;
}

double dirichlet_bytes(const MeshCounts& n, int threads) {
  return fine_bytes(n) + harmonic_bytes(n, threads);
}

ChartMap harmonic_mode(const MapProblem& fine, const std::vector<Cotangents>& cotangents,
                       const ChartOptions& options, const Work& work) {
  ChartMap map;
  run_stage("flatten", work.part(0, 0.8), map.statistics.stages,
            [&](StageStatistics&, const Work& inner) {
              map.uvs = carry_boundary(*fine.mesh, fine.coarse, fine.coarse_uvs);
              solve_harmonic(*fine.mesh, cotangents, map.uvs, inner);
            });
  mend(fine, whole_repair(fine, keeps_boundary_simple(options), options, work), options,
       work.part(0.8, 1), map);
  return map;
}

}  // namespace beltrami
