// From the coarse map to the fine one (paper section 3).
#include <utility>

#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/inherited.h"
#include "multilevel/map_problem.h"
#include "multilevel/modes.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"

namespace beltrami {
namespace {

// Shares of the progress: about those of the time with the metric solve and its polish.
constexpr double kSimplified = 0.12, kSolved = 0.23, kProlonged = 0.38;

}  // namespace

ChartMap prolonged_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                        bool harmonic, const FlattenFine& flatten, const ChartOptions& options,
                        const Work& work) {
  if (coarse_faces >= mesh.face_count()) {
    return cm_mode(mesh, "coarse", inherited.start, options, work);
  }
  MapProblem problem{.mesh = &mesh};
  simplify_fine(coarse_faces, inherited.level, work.part(0, kSimplified), problem);
  if (problem.coarse.mesh.face_count() > kLeastReduction * mesh.face_count()) {
    return joined(std::move(problem),
                  cm_mode(mesh, "coarse", {}, options, work.part(kSimplified, 1)));
  }
  solve_coarse(options, work.part(kSimplified, kSolved), problem);
  measure_fine("prolong", harmonic, options, work.part(kSolved, kProlonged), problem);
  ChartMap map = flatten(problem, work.part(kProlonged, 1));
  return joined(std::move(problem), std::move(map));
}

}  // namespace beltrami
