// Charts that cannot be mapped within reason, split until they can: two triangles always can.
#pragma once

#include <optional>
#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/types.h"
#include "base/work.h"
#include "cut/seam_target.h"
#include "multilevel/options.h"

namespace beltrami {

/// The mean energy above which a chart's map is of no use. `target`: that of the search, or none.
double beyond_reason(const std::optional<SeamTarget>& target);

/// Splits each of the charts `which` (increasing) in two halves of about the same size, or more
/// where these are no disks, and maps the parts. Charts come out by their least face of the input.
/// Returns whether there was one with more than one face. No seam runs inside a polygon, if there
/// is a way. Preconditions: no pins.
bool split_charts(const Admitted& admitted, const PolygonParts& polygons,
                  const std::vector<Index>& which, const ChartOptions& options, const Work& work,
                  std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps);

/// The same, but the parts keep the maps that they have: a half by itself may end in a worse one.
bool split_in_place(const Admitted& admitted, const PolygonParts& polygons,
                    const std::vector<Index>& which, const Work& work,
                    std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps);

/// Splits the chart that brings most energy beyond the mean that is asked for, between polygons.
/// Each half has the map that it had or one of its own, whichever has less energy. Returns whether
/// there is such a chart, and a way.
bool split_worst(const Admitted& admitted, const PolygonParts& polygons, double energy,
                 const ChartOptions& options, const Work& work, std::vector<AtlasChart>& charts,
                 std::vector<MappedChart>& maps);

/// Those of split_charts for all charts that are hopeless above `most`.
bool split_hopeless(const Admitted& admitted, const PolygonParts& polygons, double most,
                    const ChartOptions& options, const Work& work, std::vector<AtlasChart>& charts,
                    std::vector<MappedChart>& maps);

/// Sorts charts and their maps.
void sort_by_first_face(const Admitted& admitted, std::vector<AtlasChart>& charts,
                        std::vector<MappedChart>& maps);

}  // namespace beltrami
