// The stage "polish": from the map of the metric solve to a stationary point of the energy.
#pragma once

#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/chart_map.h"
#include "chart/fine_problem.h"
#include "chart/options.h"
#include "descend/contact.h"
#include "flatten/stiffness_inverse.h"

namespace beltrami {

/// How long a polish may get.
enum class PolishLength {
  kWhole,     ///< to a stationary point
  kMiddling,  ///< of a map that a finer mesh starts from
  kLong,      ///< of a map of the finest mesh where coarser ones were hard
  kShort,  ///< of a map that came from a polished one of a coarser mesh: ends where a step promises
           ///< little
};

/// With more faces a step takes a tenth of a second: a round may gain less, and steps are not
/// remembered, for memory; but where a map is polished to the end without contact, which is done
/// beside a factor of the whole mesh.
inline constexpr Index kLargeMesh = 400'000;

/// Descends from `start`, whose faces are all positive, on the schedule at the top of
/// polish_schedule.cpp. With `contact`, which is copied, the boundary stays simple; null: it may
/// cross itself. `inverse` is that of the solve, and is fitted anew on the way. Converged: ended
/// stationary. Throws Error SOLVER.
ChartMap polish_map(const FineProblem& fine, const BoundaryContact* contact, PolishLength length,
                    const ChartOptions& options, const Work& work, StiffnessInverse& inverse,
                    std::vector<Vec2> start);

}  // namespace beltrami
