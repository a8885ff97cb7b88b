#include "multilevel/polish_level.h"

#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/vectors.h"
#include "multilevel/polish_map.h"
#include "repair/touching.h"

namespace beltrami {

bool polish_level(const MapProblem& problem, const BoundaryContact& contact, bool simple,
                  PolishLength length, const ChartOptions& options, const Work& work,
                  const std::function<bool(ChartMap&)>& begin_again, StiffnessInverse& inverse,
                  ChartMap& map) {
  const auto polished_from = [&](std::vector<Vec2> start, const BoundaryContact* with) {
    return polish_map(problem, with, with ? PolishLength::kWhole : length, options, work, inverse,
                      std::move(start));
  };
  const bool pressed = simple && map.in_contact;
  ChartMap polished = polished_from(std::move(map.uvs), pressed ? &contact : nullptr);
  if (simple && !pressed && !contact.is_simple(polished.uvs) &&
      !open_touching_sides(*problem.mesh, work, polished.uvs)) {
    map.statistics.stages.push_back(given_up(polished.statistics.stages));
    parallel_free(work, polished.uvs);
    if (!begin_again(map)) return false;
    polished = polished_from(std::move(map.uvs), &contact);
    map.in_contact = true;
  }
  map.uvs = std::move(polished.uvs);
  map.converged = polished.converged;
  map.statistics.append(polished.statistics);
  return true;
}

}  // namespace beltrami
