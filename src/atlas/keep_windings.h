// Charts that lie in the plane as the input has wound their faces.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/work.h"

namespace beltrami {

/// Turns over the charts most of whose faces run against the input's, with their maps: a surface is
/// wound alike, and where the input is not, a chart of it may lie mirrored. Of charts with pins
/// none.
void keep_windings(const Admitted& admitted, std::vector<AtlasChart>& charts,
                   std::vector<MappedChart>& maps, const Work& work);

}  // namespace beltrami
