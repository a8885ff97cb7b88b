// The polish of a level that keeps its boundary simple: without contact where that will do.
#pragma once

#include <functional>

#include "base/work.h"
#include "descend/contact.h"
#include "flatten/stiffness_inverse.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/options.h"
#include "multilevel/policy.h"

namespace beltrami {

/// Polishes `map`, whose faces are all positive, to `length`. Where parts of its boundary press on
/// each other (`map.in_contact`), with `contact` to the end. Where the boundary is to stay `simple`
/// and the polish without contact has it cross itself, with contact from a new start, which
/// `begin_again` leaves in the map. Returns whether there was one.
bool polish_level(const MapProblem& problem, const BoundaryContact& contact, bool simple,
                  PolishLength length, const ChartOptions& options, const Work& work,
                  const std::function<bool(ChartMap&)>& begin_again, StiffnessInverse& inverse,
                  ChartMap& map);

}  // namespace beltrami
