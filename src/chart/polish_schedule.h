// The stage "polish": from the map of the metric solve to a stationary point of the energy.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/fine_problem.h"
#include "chart/options.h"
#include "descend/contact.h"
#include "flatten/metric.h"

namespace beltrami {

/// Descends from `start`, whose faces are all positive, on the schedule at the top of
/// polish_schedule.cpp. With `contact`, which is copied, the boundary stays simple; null: it may
/// cross itself. `laplacian` is that of the solve, and is fitted anew on the way. Converged: ended
/// stationary. Throws Error SOLVER.
ChartMap polish_map(const FineProblem& fine, const BoundaryContact* contact,
                    const ChartOptions& options, const Work& work, MetricLaplacian& laplacian,
                    std::vector<Vec2> start);

}  // namespace beltrami
