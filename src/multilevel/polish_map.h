// The stage "polish": from the map of the metric solve to a stationary point of the energy.
#pragma once

#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "descend/contact.h"
#include "flatten/stiffness_inverse.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"

namespace beltrami {

/// Descends from `start`, whose faces are all positive, on the schedule at the top of
/// polish_map.cpp. With `contact`, which is copied, the boundary stays simple; null: it may cross
/// itself. `inverse` is that of the solve, and is fitted anew on the way. Converged: ended
/// stationary. Throws Error SOLVER.
ChartMap polish_map(const MapProblem& fine, const BoundaryContact* contact, PolishLength length,
                    const ChartOptions& options, const Work& work, StiffnessInverse& inverse,
                    std::vector<Vec2> start);

}  // namespace beltrami
