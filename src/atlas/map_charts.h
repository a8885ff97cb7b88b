// One chart -> its map, and all of them side by side.
#pragma once

#include <beltrami/beltrami.h>

#include <vector>

#include "atlas/open.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "chart/options.h"

namespace beltrami {

struct MappedChart {
  std::vector<Vec2> uvs;  ///< one per vertex of the chart, in its unit
  Outcome outcome = Outcome::kOk;
  /// Why there is no map, where there is none: not injective then, all its UVs at one point.
  beltrami_status error = BELTRAMI_OK;
};

/// Flattens every chart: large ones with all threads, one after the other, the rest side by side on
/// one thread each, the largest first. Charts of up to two faces are laid flat as they are.
/// Errors stay in the map of their chart. Throws Cancelled or std::bad_alloc, and Error
/// OUT_OF_MEMORY, before any work, where a chart is estimated to need more than the limit of the
/// work.
std::vector<MappedChart> map_charts(const std::vector<AtlasChart>& charts,
                                    const ChartOptions& options, const Work& work);

}  // namespace beltrami
