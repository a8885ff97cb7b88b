// An admitted surface -> charts along seams that bring what is asked for, and their maps.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/pins.h"
#include "atlas/types.h"
#include "base/types.h"
#include "base/work.h"
#include "multilevel/chart_map.h"

namespace beltrami {

/// A face of the input that lies on another one, which is in a chart.
struct StackedFace {
  Index face = 0, on = 0;
  Triangle corner;            ///< per corner of the face that of the other with the same UV
  bool runs_against = false;  ///< positive in the plane as the other one is not
};

/// Charts and their maps, by their least face of the input.
struct MappedSurface {
  std::vector<AtlasChart> charts;
  std::vector<MappedChart> maps;
  std::vector<PinAside> pins_aside;
  std::vector<MissedTarget> missed;
  Index filled_holes = 0;
  std::vector<StackedFace> stacked;
  Index stacked_parts = 0;  ///< components that these make
};

/// Opens the surface, which was scaled by 2^exponent, and flattens its charts, as the stages "cut"
/// and "flatten". With a target each component by itself and a few times, while the maps miss it or
/// leave much of what it allows unused: as one where pins or symmetry are asked of the whole, or a
/// number of charts or a length of seams that components by themselves do not keep. No component
/// ends worse than a short cut graph leaves it. The limit of time ends the search for seams; the
/// maps along them are finished. Charts that cannot be mapped within reason are split until they
/// can, unless there are pins or a number of charts is asked for. Components that are to be stacked
/// on others have no charts. Throws Error PINS where pins cannot be met together.
MappedSurface open_and_map(const AtlasInput& input, const Admitted& admitted, int exponent,
                           const AtlasOptions& options, const Work& work,
                           std::vector<StageStatistics>& stages);

}  // namespace beltrami
