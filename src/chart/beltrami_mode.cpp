#include "chart/beltrami_mode.h"

#include <utility>
#include <vector>

#include "baselines/baselines.h"
#include "multilevel/extras.h"
#include "multilevel/map_problem.h"
#include "multilevel/modes.h"
#include "multilevel/policy.h"

namespace beltrami {
namespace {

constexpr double kMeasured = 0.1;  // share of the progress

ChartMap flatten_fine(const MapProblem& problem, const ChartOptions& options, const Work& work) {
  switch (options.flatten) {
    case Flatten::kDirichlet:
      return harmonic_mode(problem, problem.cotangents, options, work);
    case Flatten::kGif:
      return reduced_mode(problem, true, options, work);
    case Flatten::kFlim:
      return reduced_mode(problem, false, options, work);
    case Flatten::kBff:
      return boundary_first_mode(problem, options, work);
    default:
      return metric_mode(problem, options, work);
  }
}

}  // namespace

ChartMap beltrami_mode(const DiskMesh& mesh, Index coarse_faces, const Inherited& inherited,
                       const ChartOptions& options, const Work& work) {
  std::vector<StageStatistics> lost;
  if (inherited.start.empty() && has_levels(mesh.face_count(), coarse_faces, options)) {
    ChartMap map = climb_mode(mesh, inherited, options, work);
    if (!map.uvs.empty()) return map;
    require_whole_factor(mesh, options, work);
    lost.push_back(given_up(map.statistics.stages));
  }
  // The metric solve brings its own weights.
  const bool harmonic = options.flatten != Flatten::kMetric;
  const auto flatten = [&](const MapProblem& problem, const Work& share) {
    return flatten_fine(problem, options, share);
  };
  ChartMap map = prolonged_mode(mesh, coarse_faces, inherited, harmonic, flatten, options, work);
  map.statistics.stages.insert(map.statistics.stages.begin(), lost.begin(), lost.end());
  return map;
}

ChartMap plain_mode(const DiskMesh& mesh, const ChartOptions& options, const Work& work) {
  MapProblem problem{.mesh = &mesh};
  measure_fine("measure", true, options, work.part(0, kMeasured), problem);
  const Work rest = work.part(kMeasured, 1);
  ChartMap map = options.method == Method::kGif ? reduced_mode(problem, true, options, rest)
                                                : boundary_first_mode(problem, options, rest);
  return joined(std::move(problem), std::move(map));
}

}  // namespace beltrami
