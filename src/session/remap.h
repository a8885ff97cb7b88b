// One chart of a session -> its new map, from the one that it has or from nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "mesh/disk_mesh.h"
#include "multilevel/options.h"

namespace beltrami {

/// What is known of a chart before it is mapped.
struct RemapTask {
  const AtlasChart& part;
  std::vector<Vec2> start;     ///< one per vertex; where it is `placed`
  bool placed = false;         ///< the chart has a place in the plane, to which a free map returns
  bool warm = false;           ///< the start may serve as a map
  double scale = 1;            ///< lengths in the plane per length on the ground
  std::vector<ChartPin> pins;  ///< their places as delivered
  bool fit_pins = false;       ///< the map is turned and scaled to where its pins fit best
  std::vector<bool> held;      ///< per vertex, whether it may not move
  int steps = 0;               ///< Newton steps from a start; 0: to the minimum
  std::span<const Index> ranks = {};  ///< of elimination, per vertex
  bool presses = false;               ///< as Known has it
  std::uint8_t flags = 0;             ///< of ChartFlags
};

/// A map before it is rounded.
struct Draft {
  DiskMesh disk;             ///< in the unit of its map, but for the exponent
  int exponent = 0;          ///< delivered numbers are 2^-exponent times those of the map
  std::vector<Vec2> uvs;     ///< one per vertex
  std::vector<Vec2> placed;  ///< the same where the chart is to lie, in floating point
  std::vector<bool> held;    ///< vertices whose places are exact; or none
  double scale = 1;
  bool converged = true;
  bool presses = false;            ///< as HeldMap has it
  Outcome outcome = Outcome::kOk;  ///< what is known so far
};

struct Remapped {
  std::vector<Vec2> uvs;  ///< as delivered
  double scale = 1;
  bool converged = true;
  bool presses = false;
  Outcome outcome = Outcome::kOk;
  double energy = 0;  ///< see SessionChart
};

struct Drafted {
  Draft draft;
  Index failed_pin = kNone;  ///< in the list of pins of the session, one that could not be met with
                             ///< those before it
};

/// Maps a chart: near its start where that serves, else anew. Throws Cancelled or Error.
Drafted draft(const RemapTask& task, const ChartOptions& options, const Work& work);

/// Rounds, judges and measures a draft that lies where it is to, moved by `shift`.
Remapped finish(const AtlasChart& part, Draft draft, const Vec2& shift, bool float32,
                const Work& work);

/// Likewise a map as it stands, which is not moved.
Remapped judge_as_is(const AtlasChart& part, const std::vector<Vec2>& uvs, double scale,
                     const Work& work);

/// The scale of the ground at which a map has the least energy, or where it has folds as much area.
double scale_of_map(const AtlasChart& part, const std::vector<Vec2>& uvs, const Work& work);

}  // namespace beltrami
