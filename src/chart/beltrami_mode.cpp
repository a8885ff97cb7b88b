// From the coarse map to the fine one (paper section 3), and the ways to flatten on the metric of
// the surface itself.
#include <utility>

#include "base/types.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/composite_majorization.h"
#include "chart/descent.h"
#include "chart/fine_problem.h"
#include "chart/inherited.h"
#include "chart/memory_estimate.h"
#include "chart/modes.h"
#include "chart/options.h"
#include "chart/policy.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

// Shares of the progress: about those of the time with the metric solve and its polish.
constexpr double kSimplified = 0.12, kSolved = 0.23, kProlonged = 0.38;
constexpr double kMeasured = 0.1;

ChartMap flatten_fine(const FineProblem& fine, const ChartOptions& options, const Work& work) {
  switch (options.flatten) {
    case Flatten::kDirichlet:
      return dirichlet_mode(fine, fine.cotangents, options, work);
    case Flatten::kGif:
      return reduced_mode(fine, true, options, work);
    case Flatten::kFlim:
      return reduced_mode(fine, false, options, work);
    case Flatten::kBff:
      return boundary_first_mode(fine, options, work);
    default:
      return metric_mode(fine, options, work);
  }
}

}  // namespace

ChartMap beltrami_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                       const ChartOptions& options, const Work& work) {
  FineProblem fine{.mesh = &mesh};
  if (inherited.start.empty() && is_nested(mesh.face_count(), coarse_faces, options)) {
    ChartMap map = nested_mode(mesh, inherited, options, work);
    if (!map.uvs.empty()) return map;
    require_whole_factor(mesh, options, work);
    fine.statistics.stages.push_back(given_up(map.statistics.stages));
  }
  if (coarse_faces >= mesh.face_count()) {
    return joined(std::move(fine), cm_mode(mesh, "coarse", inherited.start, options, work));
  }
  simplify_fine(coarse_faces, inherited.level, work.part(0, kSimplified), fine);
  if (fine.coarse.mesh.face_count() > kLeastReduction * mesh.face_count()) {
    return joined(std::move(fine), cm_mode(mesh, "coarse", {}, options, work.part(kSimplified, 1)));
  }
  solve_coarse(options, work.part(kSimplified, kSolved), fine);
  // The metric solve brings its own weights.
  const bool harmonic = options.flatten != Flatten::kMetric;
  measure_fine("prolong", harmonic, options, work.part(kSolved, kProlonged), fine);
  ChartMap map = flatten_fine(fine, options, work.part(kProlonged, 1));
  return joined(std::move(fine), std::move(map));
}

ChartMap plain_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work) {
  FineProblem fine{.mesh = &mesh};
  measure_fine("measure", true, options, work.part(0, kMeasured), fine);
  const Work rest = work.part(kMeasured, 1);
  ChartMap map = options.method == Method::kGif ? reduced_mode(fine, true, options, rest)
                                                : boundary_first_mode(fine, options, rest);
  return joined(std::move(fine), std::move(map));
}

}  // namespace beltrami
