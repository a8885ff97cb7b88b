// A chart and its map -> the charts and maps of its parts, which keep the place that they have.
#pragma once

#include <vector>

#include "admit/admit.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "base/types.h"
#include "base/work.h"
#include "cut/edge_marks.h"

namespace beltrami {

struct ChartPart {
  AtlasChart chart;
  MappedChart map;
};

/// Per real face of a chart the least one of those that it is connected with over edges of real
/// faces: virtual ones do not connect what is delivered.
std::vector<Index> real_pieces(const AtlasChart& chart);

/// The parts of a chart along marked edges of its mesh, by their least face, without those that
/// have no real face; none at all where one is no disk. Precondition: the chart has no pins.
std::vector<ChartPart> parts_along(const AtlasChart& chart, const MappedChart& map,
                                   const EdgeMarks& marks, const Work& work);

/// Parts charts whose real faces hang together over virtual ones alone, or at a vertex: a page has
/// room for the margin between them. Where a part would be no disk, and beyond `most_charts` (0: no
/// limit), charts stay as they are; so do those with pins or without a map. Charts come out by
/// their least face of the input.
void separate_pieces(const Admitted& admitted, Index most_charts, std::vector<AtlasChart>& charts,
                     std::vector<MappedChart>& maps, const Work& work);

}  // namespace beltrami
