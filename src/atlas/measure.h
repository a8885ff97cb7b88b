// What an atlas is worth: its distortion and its seams.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"

namespace beltrami {

/// Measures the real faces of maps, one per chart, and fills the energies and areas of `charts`, in
/// the unit of the surface. Densities do not count as distortion, nor does `scale`, by which all
/// maps were scaled.
AtlasEnergy measure_charts(const std::vector<AtlasChart>& parts,
                           const std::vector<MappedChart>& maps, double scale,
                           std::vector<ChartInfo>& charts, const Work& work);

/// Of the real faces of charts, on the surface.
double area_of(const std::vector<AtlasChart>& charts);

/// Length of the edges of the surface at which charts end on two sides or more, half of it for each
/// side; virtual faces have none. `vertex`: per vertex of the surface, equal for those that are one
/// in the input.
double seam_length(const std::vector<AtlasChart>& charts, const std::vector<Index>& vertex);

}  // namespace beltrami
