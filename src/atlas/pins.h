// Pins: from corners of the input to vertices of charts.
#pragma once

#include <string>
#include <vector>

#include "admit/admit.h"
#include "atlas/open.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "pins/hold.h"

namespace beltrami {

/// A corner of the input that is held.
struct Pin {
  Index face;       ///< of the input
  int corner;       ///< of the face
  Vec2 uv;          ///< in the unit of the UVs delivered, finite
  Index number;     ///< as the caller counts pins; several corners of triangles may be one of a
  Index of_caller;  ///< polygon: that corner, as the caller counts
  PinKind kind = PinKind::kPoint;
  Vec2 along = Vec2::Zero();  ///< of kLine: its direction
  Vec2 given = Vec2::Zero();  ///< `uv` as the caller gave it: kinds zero what they do not hold
};

/// A pin of a vertex of a chart.
struct ChartPin {
  Index vertex;
  Vec2 place;  ///< in the unit of the charts
  Index pin;   ///< its place in the list of pins
  PinKind kind = PinKind::kPoint;
  Vec2 along = Vec2::Zero();  ///< of kLine: its direction
};

/// A pin of a face that lies in no chart.
struct PinAside {
  Index face;
  int corner;
  Vec2 place;
};

struct AssignedPins {
  std::vector<std::vector<ChartPin>> of_chart;  ///< in the order of the pins, each vertex once
  std::vector<PinAside> aside;
};

/// Finds the vertices that are pinned. The charts' unit is 2^-exponent of that of the UVs: places
/// are exact. Throws Error PINS with the corner where corners with one UV vertex are to lie apart,
/// or where a place is beyond the range of numbers.
AssignedPins assign_pins(const std::vector<Pin>& pins, const std::vector<Triangle>& faces,
                         const Admitted& admitted, const std::vector<AtlasChart>& charts,
                         int exponent);

/// "pin 3 (corner 17)".
std::string name_of(const Pin& pin);

/// That a pin cannot be met, `why` being the end of a sentence that begins with its name.
Error unmet(const Pin& pin, const std::string& why);

}  // namespace beltrami
