// Charts that fill their hulls badly, cut in two where that lets more of the pages be filled than
// the seam is worth.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/pages.h"
#include "base/types.h"
#include "base/work.h"
#include "pack/types.h"

namespace beltrami {

struct SplitRules {
  double price = 0;        ///< length of seams, in roots of the area, for all of the utilisation
  Index most_charts = 0;   ///< that there may be then; 0: any number
  double seam_budget = 0;  ///< in roots of the area, for all seams; 0: any length
  PolygonParts polygons = {};  ///< no seam runs inside one
};

/// Charts and what belongs to each.
struct SplitCharts {
  std::vector<AtlasChart>& charts;
  std::vector<MappedChart>& maps;
  std::vector<double>& scales;
};

/// Packs the maps as pack_maps does, and with charts split in two at necks, each part a connected
/// disk with the map that it had, as long as the utilisation gained is worth the seams at the
/// price: judged, one split after the other, by packings of little effort, and in the end on the
/// pages that are delivered. Where it is not, charts stay as they are. Maps that failed or are not
/// injective are not split, and nothing is where a map would not be sound on its page. Charts come
/// by their least face of the input again; a part has the scale of the whole. Time: some ten small
/// packings, and two or three whole ones. Preconditions: a price above 0, and no texels per unit in
/// `options`.
Pages pack_split_maps(const Admitted& admitted, const SplitRules& rules, const PackOptions& options,
                      bool float32, SplitCharts charts, const Work& work);

}  // namespace beltrami
