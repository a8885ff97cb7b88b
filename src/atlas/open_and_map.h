// An admitted surface -> charts along seams that bring what is asked for, and their maps.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/atlas.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/work.h"
#include "chart/chart_map.h"

namespace beltrami {

/// Charts and their maps.
struct Mapped {
  OpenedSurface opened;
  AssignedPins pins;
  std::vector<MappedChart> maps;
  AtlasEnergy energy;
};

/// Opens the surface, which was scaled by 2^exponent, and flattens its charts, as the stages "cut"
/// and "flatten"; with a target again, a few times, while the maps miss it or leave much of what it
/// allows unused. Throws Error PINS where pins cannot be met together.
Mapped open_and_map(const AtlasInput& input, const Admitted& admitted, int exponent,
                    const AtlasOptions& options, const Work& work,
                    std::vector<StageStatistics>& stages);

}  // namespace beltrami
