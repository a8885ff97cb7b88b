// What an atlas is worth: its distortion and its seams.
#pragma once

#include <vector>

#include "atlas/atlas.h"
#include "atlas/map_charts.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/chart.h"

namespace beltrami {

/// Measures maps, one per chart, and fills the energies and areas of `charts`, in the unit of the
/// surface.
AtlasEnergy measure_charts(const std::vector<Chart>& parts, const std::vector<MappedChart>& maps,
                           std::vector<ChartInfo>& charts, const Work& work);

/// Length of the edges of the surface at which charts end on two sides or more, half of it for each
/// side. `vertex`: per vertex of the surface, equal for those that are one in the input.
double seam_length(const std::vector<Chart>& charts, const std::vector<Index>& vertex);

}  // namespace beltrami
