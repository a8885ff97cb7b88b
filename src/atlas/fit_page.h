// Charts that are larger than a page at the density that is asked for.
#pragma once

#include <vector>

#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/types.h"
#include "pack/types.h"

namespace beltrami {

/// Those that lie on no page, however they may be turned, increasing; none where parts of them
/// would not help: a face is larger than a page, or all have more area than all pages. Maps that
/// failed are left out. Options: texels per unit of the maps, above 0.
std::vector<Index> larger_than_page(const std::vector<AtlasChart>& charts,
                                    const std::vector<MappedChart>& maps,
                                    const PackOptions& options);

}  // namespace beltrami
