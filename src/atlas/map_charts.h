// One chart -> its map, and all of them side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "multilevel/options.h"

namespace beltrami {

struct MappedChart {
  std::vector<Vec2> uvs;  ///< one per vertex of the chart, in its unit
  Outcome outcome = Outcome::kOk;
  /// Why there is no map, where there is none: not injective then, all its UVs at one point.
  std::optional<Fault> error = {};
  /// Per vertex, whether it is pinned, and lies in its place exactly; empty: the chart has no pins.
  std::vector<bool> held = {};
  double scale = 1;         ///< of a map with pins, see hold_pins; else 1
  bool fits_single = true;  ///< on a page: injective when it is stored in single precision, too
  /// What is straight of it runs along the axes: 4, quarter turns alone keep it there; 2, half
  /// turns, since one coordinate of it was asked for; 0: it may be turned anyhow.
  int own_turns = 0;
  std::uint64_t page_group = 0;  ///< as PackChart has it
  Index failed_pin = kNone;      ///< in the list of all pins: could not be met with those before it

  bool pinned() const { return !held.empty(); }
};

/// Flattens every chart: large ones with all threads, one after the other, the rest side by side on
/// one thread each, the largest first. Charts of up to two faces are laid flat as they are.
/// Charts with pins are held by them, in their places at once. Errors stay in the map of their
/// chart. Throws Cancelled or std::bad_alloc, and Error
/// OUT_OF_MEMORY, before any work, where a chart is estimated to need more than the limit of the
/// work.
std::vector<MappedChart> map_charts(const std::vector<AtlasChart>& charts, const AssignedPins& pins,
                                    const ChartOptions& options, const Work& work);

}  // namespace beltrami
